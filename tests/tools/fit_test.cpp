// A grown surface is fitted to another one, by `vmesh fit` and together with growth.
#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/topology.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using Json = nlohmann::json;

/// The surface of the small tree, and one as from a scan: a tenth wider, oval, finer.
class Fit : public CommandTest {
 protected:
  Fit() {
    write_y("y.swc");
    EXPECT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "-q"}).exit_code, 0);
    EXPECT_EQ(vmesh({"generate", "@y.swc", "-o", "@fine.off", "--around", "14", "-q"}).exit_code, 0);
    LoadedSurface scan = read_surface(path("fine.off"));
    for (Vec3& p : scan.mesh.vertices) p = Vec3(1.15 * p.x(), 1.05 * p.y(), p.z());
    write_surface(path("scan.stl"), scan.mesh);
  }

  Outcome fit(std::vector<std::string> more, const std::string& surface = "@y.ply") const {
    more.insert(more.begin(), {"fit", surface, "@scan.stl", "--reference-unit", "mm", "--reference-space", "LPS",
                               "--centerline", "@y.swc", "-o", "@fitted.ply"});
    return vmesh(more);
  }
};

TEST_F(Fit, HalvesTheDistanceAndStaysSound) {
  const Outcome run = fit({"--json", "@fit.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json summary = Json::parse(read("fit.json"));
  EXPECT_LT(summary["fit"]["after"]["p95_mm"].get<double>(), 0.5 * summary["fit"]["before"]["p95_mm"].get<double>());
  const LoadedSurface before = read_surface(path("y.ply")), after = read_surface(path("fitted.ply"));
  EXPECT_LE(after.mesh.vertices.size(), before.mesh.vertices.size() * 21 / 20);
  EXPECT_TRUE(measure_topology(after.mesh).closed);
  EXPECT_TRUE(self_intersections(after.mesh).empty());
  const auto names = [](const LoadedSurface& surface) {
    std::string text;
    for (const MeshAttribute& a : surface.attributes.vertex) text += a.name + " ";
    return text;
  };
  EXPECT_EQ(names(after), names(before));
  ASSERT_EQ(vmesh({"fit", "@fitted.ply", "@scan.stl", "--centerline", "@y.swc", "-o", "@again.ply"}).exit_code, 0)
      << "what it writes can be fitted again";
}

TEST_F(Fit, KeepTrianglesMovesVerticesAlone) {
  ASSERT_EQ(fit({"--keep-triangles"}).exit_code, 0);
  EXPECT_EQ(read_surface(path("fitted.ply")).mesh.faces, read_surface(path("y.ply")).mesh.faces);
}

TEST_F(Fit, AnErrorThatIsNotReachedIsToldByTheExitCode) {
  const Outcome loose = fit({"--fit-error", "0.4mm", "--json", "@loose.json"});
  ASSERT_EQ(loose.exit_code, 0) << loose.err;
  const Outcome tight = fit({"--fit-error", "0.001mm", "--max-vertices", "700", "--json", "@tight.json"});
  EXPECT_EQ(tight.exit_code, 6) << tight.err;
  EXPECT_LE(Json::parse(read("loose.json"))["fit"]["after"]["p95_mm"].get<double>(), 0.4);
  EXPECT_GT(Json::parse(read("tight.json"))["fit"]["after"]["p95_mm"].get<double>(), 0.001);
  EXPECT_LE(read_surface(path("fitted.ply")).mesh.vertices.size(), 700u) << "the limit on vertices holds";
}

TEST_F(Fit, ALargestErrorIsProvenOrItsPlacesAreListed) {
  const Outcome loose = fit({"--fit-error", "max=0.6mm", "--json", "@loose.json"});
  ASSERT_EQ(loose.exit_code, 0) << loose.err;
  const Json kept = Json::parse(read("loose.json"));
  EXPECT_EQ(kept["fit"]["beyond"]["count"], 0);
  EXPECT_NE(kept["options"].get<std::string>().find("--fit-error max=0.6mm"), std::string::npos);
  ASSERT_EQ(kept["fit"]["uncovered"]["count"], 0);
  ASSERT_EQ(kept["fit"]["unsupported"]["count"], 0);
  EXPECT_LE(kept["fit"]["after"]["hausdorff_mm"]["lower"].get<double>(), 0.6);
  const Outcome tight = fit({"--fit-error", "max=0.01mm", "--max-vertices", "700", "--json", "@tight.json"});
  EXPECT_EQ(tight.exit_code, 6) << tight.err;
  EXPECT_NE(tight.err.find("farther than 0.010 mm: "), std::string::npos) << tight.err;
  EXPECT_GT(Json::parse(read("tight.json"))["fit"]["beyond"]["count"], 0);
  EXPECT_LE(read_surface(path("fitted.ply")).mesh.vertices.size(), 700u);
  const Outcome wrong = fit({"--fit-error", "max=5%"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("max=0.5mm"), std::string::npos) << wrong.err;
  EXPECT_EQ(fit({"--fit-error", "max=0.6mm", "--keep-triangles"}).exit_code, 3);
}

TEST_F(Fit, ABudgetIsANumberOfVerticesOrAnError) {
  const Outcome few = fit({"--budget", "vertices=300", "--json", "@few.json"});
  ASSERT_EQ(few.exit_code, 0) << few.err;
  EXPECT_LE(read_surface(path("fitted.ply")).mesh.vertices.size(), 300u);
  EXPECT_NE(Json::parse(read("few.json"))["options"].get<std::string>().find("--max-vertices 300"), std::string::npos);
  ASSERT_EQ(fit({"--budget", "error=0.4mm"}).exit_code, 0);
  const std::string by_budget = read("fitted.ply");
  ASSERT_EQ(fit({"--fit-error", "0.4mm"}).exit_code, 0);
  EXPECT_EQ(read("fitted.ply"), by_budget);
  for (const char* budget : {"time=1s", "error=5%"}) {
    const Outcome run = fit({"--budget", budget});
    EXPECT_EQ(run.exit_code, 2) << budget;
    EXPECT_NE(run.err.find("a fit takes budgets such as"), std::string::npos) << run.err;
  }
}

TEST_F(Fit, GrowsAndFitsInOneGo) {
  const Outcome run = vmesh({"generate", "@y.swc", "--fit", "@scan.stl", "-o", "@one.ply", "--json", "@one.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json fit = Json::parse(read("one.json"))["fit"];
  EXPECT_LT(fit["after"]["p95_mm"].get<double>(), 0.5 * fit["before"]["p95_mm"].get<double>());
  EXPECT_TRUE(self_intersections(read_surface(path("one.ply")).mesh).empty());
}

TEST_F(Fit, TrianglesMayBeLong) {
  ASSERT_EQ(fit({"--json", "@even.json"}).exit_code, 0);
  const Json even = Json::parse(read("even.json"));
  const std::string vertices = "vertices=" + std::to_string(even["vertices"].get<int>());
  const Outcome alone = fit({"--elongation", "16", "--budget", vertices, "--json", "@long.json"});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  const Outcome grown = vmesh({"generate", "@y.swc", "--fit", "@scan.stl", "--elongation", "16", "--budget", vertices,
                               "-o", "@one.ply", "--json", "@one.json"});
  ASSERT_EQ(grown.exit_code, 0) << grown.err;
  for (const char* file : {"long.json", "one.json"}) {
    const Json summary = Json::parse(read(file));
    EXPECT_LE(summary["vertices"], even["vertices"]) << file;
    EXPECT_LT(summary["fit"]["after"]["mean_mm"].get<double>(), 0.8 * even["fit"]["after"]["mean_mm"].get<double>());
    EXPECT_LT(summary["metric_skewness"]["mean"].get<double>(), summary["skewness"]["mean"].get<double>()) << file;
  }
  EXPECT_EQ(Json::parse(read("one.json"))["options"]["elongation"], 16);
}

TEST_F(Fit, WhatCannotBeFittedIsRefusedAndNothingWritten) {
  const auto expect_refused = [&](const Outcome& run, int exit_code, const std::string& text) {
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_NE(run.err.find(text), std::string::npos) << run.err;
    EXPECT_FALSE(exists("fitted.ply"));
  };
  expect_refused(fit({}, "@fine.off"), 3, "no places on a centerline");
  expect_refused(fit({"--label", "2"}), 2, "for images");
  write("short.swc", "# SPACE=LPS\n# UNIT=mm\n1 0 0 0 0 1 -1\n2 0 0 0 9 1 1\n");
  expect_refused(vmesh({"fit", "@y.ply", "@scan.stl", "--centerline", "@short.swc", "-o", "@fitted.ply"}), 3,
                 "y.ply: vertex");
  LoadedSurface crossing = read_surface(path("y.ply"));
  std::swap(crossing.mesh.vertices[0], crossing.mesh.vertices.back());
  write_surface(path("crossing.ply"), crossing.mesh, crossing.attributes);
  expect_refused(fit({}, "@crossing.ply"), 3, "cross");
  expect_refused(vmesh({"generate", "@y.swc", "--fit-error", "0.1mm", "-o", "@fitted.ply"}), 2, "--fit");
  expect_refused(vmesh({"generate", "@y.swc", "--fit", "@scan.stl", "--max-error", "5%", "-o", "@fitted.ply"}), 2,
                 "--fit-error");
  expect_refused(vmesh({"generate", "@y.swc", "--fit", "@scan.stl", "--budget", "time=1s", "-o", "@fitted.ply"}), 2,
                 "budgets");
  for (const char* option : {"--keep-triangles", "--least-vertices=100"}) {
    const std::vector<std::string> words = {"generate",     "@y.swc", "--fit", "@scan.stl",  option,
                                            "--elongation", "4",      "-o",    "@fitted.ply"};
    expect_refused(vmesh(words), 2, "fitting to long triangles");
  }
  expect_refused(vmesh({"generate", "@y.swc", "--centerline-output", "@c.json", "-o", "@fitted.ply"}), 2, "image");
}

}  // namespace
}  // namespace vmesh::testing

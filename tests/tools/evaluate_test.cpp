#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using nlohmann::json;

class Evaluate : public CommandTest {
 protected:
  Evaluate() {
    write_box("box.off", 1);
    write_box("tall.off", 3);
  }

  // The box [0, 2] x [0, 2] x [0, height].
  void write_box(const std::string& name, double height) const {
    const std::string h = std::to_string(height);
    write(name, "OFF\n8 12 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n0 0 " + h + "\n2 0 " + h + "\n2 2 " + h + "\n0 2 " + h +
                    "\n3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n"
                    "3 3 0 4\n3 3 4 7\n");
  }

  json evaluate(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "evaluate");
    arguments.insert(arguments.end(), {"--json", "-", "-q"});
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out);
  }
};

TEST_F(Evaluate, MeasuresASurfaceAlone) {
  const json report = evaluate({"@box.off"});
  EXPECT_EQ(report.at("schema"), "vmesh.evaluation/1");
  EXPECT_EQ(report.at("faces"), 12);
  EXPECT_NEAR(report.at("area_mm2").get<double>(), 16, 1e-12);
  EXPECT_NEAR(report.at("enclosed_volume_mm3").get<double>(), 4, 1e-12);
  EXPECT_EQ(report.at("topology").at("closed"), true);
  EXPECT_EQ(report.at("topology").at("genus"), 0);
  EXPECT_EQ(report.at("defects").at("self_intersections"), 0);
  // Four faces are 90-45-45, eight have their least angle at atan(1 / 2).
  const json& skewness = report.at("face_measures").at("equiangle_skewness");
  EXPECT_NEAR(skewness.at("min").get<double>(), 0.25, 1e-12);
  EXPECT_NEAR(skewness.at("max").get<double>(), 1 - std::atan(0.5) / (std::acos(-1) / 3), 1e-12);
  std::size_t counted = 0;
  for (const json& bin : skewness.at("histogram").at("counts")) counted += bin.get<std::size_t>();
  EXPECT_EQ(counted, 12u);
  EXPECT_TRUE(report.at("reference").is_null());
  EXPECT_TRUE(report.at("volume").is_null());
}

TEST_F(Evaluate, SaysTheSameOnAnyNumberOfThreads) {
  const auto on = [&](const char* threads) {
    return evaluate({"@box.off", "--reference", "@tall.off", "--threads", threads});
  };
  EXPECT_EQ(on("1"), on("2"));
  EXPECT_EQ(vmesh({"evaluate", "@box.off", "--threads", "-1"}).exit_code, 2);
}

TEST_F(Evaluate, ComparesWithAReference) {
  const json report = evaluate({"@box.off", "--reference", "@tall.off", "--tolerance", "1e-3"});
  const json& reference = report.at("reference");
  EXPECT_EQ(reference.at("against"), "reference surface");
  const auto expect_bounds = [](const json& bounds, double exact) {
    EXPECT_LE(bounds.at("lower").get<double>(), exact);
    EXPECT_GE(bounds.at("upper").get<double>(), exact);
    EXPECT_LE(bounds.at("upper").get<double>() - bounds.at("lower").get<double>(), 1e-3);
  };
  // The lid at height 1: its middle is 1 from the walls and from the bottom.
  expect_bounds(reference.at("from_surface").at("hausdorff_mm"), 1);
  expect_bounds(reference.at("from_reference").at("hausdorff_mm"), 2);
  expect_bounds(reference.at("hausdorff_mm"), 2);
  EXPECT_EQ(reference.at("from_reference").at("farthest").at("at").at(2), 3);
  EXPECT_LE(reference.at("from_reference").at("sampled_mm").at("max").get<double>(), 2);
  EXPECT_EQ(reference.at("from_reference").at("sampled_mm").at("count"), 100000);
  EXPECT_NEAR(reference.at("from_reference").at("samples_per_mm2").get<double>(), 100000 / 32.0, 1e-9);
}

TEST_F(Evaluate, ComparesWithTheVesselsOfACenterline) {
  write_y("y.swc");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "--around", "16"}).exit_code, 0);
  const json volume = evaluate({"@y.ply", "--centerline", "@y.swc", "--samples", "20000"}).at("volume");
  EXPECT_EQ(volume.at("against"), "round-cone volume of the centerline");
  for (const char* side : {"from_surface", "from_volume"}) {
    const json& relative = volume.at(side).at("sampled_in_local_radii");
    EXPECT_LT(relative.at("median").get<double>(), 0.05) << side;  // 16 around: 1 - cos(pi / 16) is 0.02
    EXPECT_GT(relative.at("median").get<double>(), 0.001) << side;
    EXPECT_GT(volume.at(side).at("sampled_mm").at("count").get<int>(), 10000) << side;
  }
}

TEST_F(Evaluate, RequirementsDecideTheExitCode) {
  const auto code = [this](const std::string& list) {
    return vmesh({"evaluate", "@box.off", "--reference", "@tall.off", "--require", list}).exit_code;
  };
  EXPECT_EQ(code("closed,manifold,oriented,outward,no-self-intersections,no-degenerate-faces"), 0);
  EXPECT_EQ(code("components=1,genus=0,max-faces=12,min-angle=26,max-skewness=0.6,mean-skewness=0.6"), 0);
  EXPECT_EQ(code("hausdorff=2.001,hausdorff-to-reference=1.001,hausdorff-from-reference=2.001,mean-distance=2"), 0);
  for (const char* unmet : {"closed,components=2", "genus=1", "max-faces=11", "min-angle=27", "max-skewness=0.5",
                            "mean-skewness=0.2", "hausdorff=1.9", "hausdorff-to-reference=0.9", "mean-distance=0.01"})
    EXPECT_EQ(code(unmet), 1) << unmet;
  const Outcome run = vmesh({"evaluate", "@box.off", "--require", "max-faces=11"});
  EXPECT_NE(run.err.find("max-faces=11; found 12"), std::string::npos) << run.err;
}

TEST_F(Evaluate, RequirementsThatMakeNoSenseAreUsageErrors) {
  for (const char* list : {"close", "closed=1", "max-skewness", "max-skewness=much", "max-skewness=nan", "=3",
                           "hausdorff=1", "volume-distance=1"}) {
    const Outcome run = vmesh({"evaluate", "@box.off", "--require", list, "-o", "@colored.ply"});
    EXPECT_EQ(run.exit_code, 2) << list;
    EXPECT_NE(run.err.find("--require"), std::string::npos) << run.err;
    EXPECT_FALSE(exists("colored.ply"));
  }
}

TEST_F(Evaluate, WritesTheSurfaceWithWhatToColourItBy) {
  write_y("y.swc");
  std::vector<std::string> names = {"colored.ply", "colored.vtp"};
  for (const std::string& name : names) {
    ASSERT_EQ(vmesh({"evaluate", "@box.off", "--reference", "@tall.off", "--centerline", "@y.swc", "-o", "@" + name})
                  .exit_code,
              0);
    const LoadedSurface surface = read_surface(path(name));
    const bool is_ply = name == "colored.ply";
    ASSERT_EQ(surface.attributes.vertex.size(), is_ply ? 3u : 2u);
    EXPECT_EQ(surface.attributes.vertex[0].name, "distance");
    // The corners of the lid lie on the walls of the other box, to the rounding of coordinates of 2.
    for (const double distance : surface.attributes.vertex[0].values) EXPECT_LT(distance, 1e-15);
    EXPECT_EQ(surface.attributes.vertex[1].name, "volume_distance");
    if (is_ply) {
      EXPECT_EQ(surface.attributes.vertex[2].name, "quality");
      EXPECT_EQ(surface.attributes.vertex[2].values, surface.attributes.vertex[1].values);
    }
    ASSERT_EQ(surface.attributes.face.size(), 1u);
    EXPECT_EQ(surface.attributes.face[0].name, "EquiangleSkewness");
    EXPECT_NEAR(surface.attributes.face[0].values[0], 0.25, 1e-12);
  }
}

TEST_F(Evaluate, ReportsInEveryFormat) {
  const std::vector<std::string> call = {"evaluate", "@box.off", "--reference", "@tall.off"};
  const auto with = [&](std::initializer_list<std::string> more) {
    std::vector<std::string> all = call;
    all.insert(all.end(), more);
    return vmesh(all);
  };
  EXPECT_NE(with({}).out.find("Hausdorff distance to the reference surface"), std::string::npos);
  const std::string markdown = with({"--format", "markdown"}).out, csv = with({"--format", "csv"}).out;
  EXPECT_NE(markdown.find("\n|---"), std::string::npos);
  EXPECT_EQ(csv.rfind("table,row,column,value\n", 0), 0u);
  EXPECT_NE(csv.find("\nsurface,faces,value,12\n"), std::string::npos);
  for (const char* name : {"r.txt", "r.md", "r.csv", "r.json"}) {
    EXPECT_EQ(with({"--report", "@" + std::string(name)}).exit_code, 0);
    EXPECT_GT(read(name).size(), 200u);
  }
  EXPECT_EQ(read("r.md"), markdown);
  EXPECT_EQ(read("r.csv"), csv);
  EXPECT_EQ(json::parse(read("r.json")).at("faces"), 12);
  EXPECT_EQ(with({"--report", "@r.pdf"}).exit_code, 4);
}

TEST_F(Evaluate, BadInputNamesTheFile) {
  write("empty.off", "OFF\n0 0 0\n");
  write("nan.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n");
  write("far.off", "OFF\n3 1 0\n0 0 0\n1e17 0 0\n0 1 0\n3 0 1 2\n");
  for (const char* name : {"empty.off", "nan.off", "far.off", "missing.off"}) {
    for (const auto& arguments : {std::vector<std::string>{"evaluate", "@" + std::string(name)},
                                  {"evaluate", "@box.off", "--reference", "@" + std::string(name)}}) {
      const Outcome run = vmesh(arguments);
      EXPECT_EQ(run.exit_code, 3) << name << run.err;
      EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
    }
  }
  EXPECT_EQ(vmesh({"evaluate", "@box.off", "--reference", "@box.off", "--tolerance", "1e-12"}).exit_code, 3);
  EXPECT_EQ(vmesh({"evaluate", "@box.off", "--tolerance", "nan"}).exit_code, 2);
  EXPECT_EQ(vmesh({"evaluate", "@box.off", "-o", "@box.off"}).exit_code, 2);
}

TEST_F(Evaluate, ReferencesInOtherUnitsAreConverted) {
  const json report =
      evaluate({"@box.off", "--unit", "cm", "--space", "LPS", "--reference", "@box.off", "--reference-unit", "mm"});
  EXPECT_NEAR(report.at("enclosed_volume_mm3").get<double>(), 4000, 1e-9);
  const json& bounds = report.at("reference").at("hausdorff_mm");
  const double exact = std::sqrt(18 * 18 + 18 * 18 + 9 * 9);  // between the far corners
  EXPECT_LE(bounds.at("lower").get<double>(), exact);
  EXPECT_GE(bounds.at("upper").get<double>(), exact);
}

TEST_F(Evaluate, TheSameInputGivesTheSameBytes) {
  const std::vector<std::string> call = {"evaluate", "@box.off", "--reference", "@tall.off", "--json", "-"};
  EXPECT_EQ(vmesh(call).out, vmesh(call).out);
}

}  // namespace
}  // namespace vmesh::testing

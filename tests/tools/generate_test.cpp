#include <algorithm>

#include <nlohmann/json.hpp>

#include "vmesh/core/version.h"
#include "vmesh/io/sha256.h"
#include "vmesh/io/surface_io.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using nlohmann::json;

class Generate : public CommandTest {
 protected:
  Generate() { write_y("y.swc"); }
};

TEST_F(Generate, WritesEverySurfaceFormat) {
  std::vector<std::string> names = {"y.ply", "y.stl", "y.obj", "y.off"};
  if (VMESH_TEST_WITH_VTK) names.push_back("y.vtp");
  for (const std::string& name : names) {
    const Outcome run = vmesh({"generate", "@y.swc", "-o", "@" + name});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_GT(read_surface(path(name)).mesh.faces.size(), 20u) << name;
  }
}

TEST_F(Generate, VerticesKeepTheirPlaceOnTheCenterline) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  const LoadedSurface surface = read_surface(path("y.ply"));
  std::vector<std::string> names;
  for (const MeshAttribute& attribute : surface.attributes.vertex) {
    names.push_back(attribute.name);
    ASSERT_EQ(attribute.values.size(), surface.mesh.vertices.size());
    const auto [low, high] = std::minmax_element(attribute.values.begin(), attribute.values.end());
    const double most = attribute.name == "segment" || attribute.name == "branch" ? 2
                        : attribute.name == "parameter"                           ? 1
                                                                                  : 3 + 1e-9;
    EXPECT_GE(*low, attribute.name == "radius" ? 2.1 - 1e-9 : 0) << attribute.name;
    EXPECT_LE(*high, most) << attribute.name;
  }
  for (const char* name : {"radius", "segment", "parameter", "branch"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  ASSERT_EQ(surface.attributes.face.size(), 2u);
  EXPECT_EQ(surface.attributes.face[0].name, "EquiangleSkewness");
}

TEST_F(Generate, FacesKnowTheirBranch) {
  std::vector<std::string> names = {"y.ply"};
  if (VMESH_TEST_WITH_VTK) names.push_back("y.vtp");
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@" + name}).exit_code, 0);
    const LoadedSurface surface = read_surface(path(name));
    ASSERT_EQ(surface.attributes.face.size(), 2u);
    const MeshAttribute& branch = surface.attributes.face[1];
    EXPECT_EQ(branch.name, "branch");
    EXPECT_TRUE(branch.integer);
    ASSERT_EQ(branch.values.size(), surface.mesh.faces.size());
    for (const double label : {0, 1, 2}) EXPECT_GT(std::count(branch.values.begin(), branch.values.end(), label), 10);
    EXPECT_EQ(*std::max_element(branch.values.begin(), branch.values.end()), 2);
  }
}

TEST_F(Generate, SummaryTellsWhatCameOut) {
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.ply", "--json", "@y.json", "--beta", "0.25"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json summary = json::parse(read("y.json"));
  const LoadedSurface surface = read_surface(path("y.ply"));
  EXPECT_EQ(summary.at("schema"), "vmesh.summary/1");
  EXPECT_EQ(summary.at("generator").at("version"), std::string(version()));
  EXPECT_EQ(summary.at("input").at("sha256"), sha256_of_file(path("y.swc")));
  EXPECT_EQ(summary.at("options").at("beta"), 0.25);
  EXPECT_EQ(summary.at("vertices"), surface.mesh.vertices.size());
  EXPECT_EQ(summary.at("faces"), surface.mesh.faces.size());
  const json& topology = summary.at("topology");
  for (const char* property : {"closed", "manifold", "oriented", "outward"}) EXPECT_EQ(topology.at(property), true);
  EXPECT_EQ(topology.at("genus"), topology.at("expected_genus"));
  EXPECT_EQ(topology.at("components"), topology.at("expected_components"));
  EXPECT_EQ(summary.at("self_intersections"), 0);
  EXPECT_EQ(summary.at("nodes_inside"), 4);
  EXPECT_EQ(summary.at("centerline").at("nodes"), 4);
  EXPECT_EQ(summary.at("centerline").at("branches"), 3);
  EXPECT_GT(summary.at("distance").at("mean_relative"), 0.01);  // no polygon is a circle
  EXPECT_LT(summary.at("distance").at("mean_relative"), 0.2);
  EXPECT_GE(summary.at("distance").at("max_mm"), summary.at("distance").at("mean_mm"));
  EXPECT_GT(summary.at("skewness").at("mean"), 0.0);
  EXPECT_GT(summary.at("vertices_per_length_in_radii"), 0.0);
  EXPECT_GT(summary.at("seconds").at("total"), 0.0);
  EXPECT_TRUE(summary.at("problems").empty()) << summary.at("problems");
}

TEST_F(Generate, AFinerSurfaceIsCloserToTheVolume) {
  const auto distance = [this](const char* around) {
    const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.ply", "--json", "-", "--around", around});
    return json::parse(run.out).at("distance").at("mean_relative").get<double>();
  };
  EXPECT_LT(distance("14"), 0.5 * distance("6"));
}

TEST_F(Generate, SummaryOnStdoutIsAllThatIsThere) {
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.ply", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out).at("schema"), "vmesh.summary/1");
}

TEST_F(Generate, QuietSaysNothing) {
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.ply", "--quiet"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out + run.err, "");
}

TEST_F(Generate, LogHasNoProgressBarAwayFromATerminal) {
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.ply"});
  EXPECT_EQ(run.err.find('\r'), std::string::npos);
  EXPECT_NE(run.err.find("wrote"), std::string::npos);
}

TEST_F(Generate, TheSameInputGivesTheSameBytes) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@a.ply"}).exit_code, 0);
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@b.ply"}).exit_code, 0);
  EXPECT_EQ(read("a.ply"), read("b.ply"));
}

TEST_F(Generate, CheckPassesAFlawlessSurface) {
  EXPECT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "--check"}).exit_code, 0);
}

TEST_F(Generate, UnitScalesTheSurface) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@mm.ply"}).exit_code, 0);
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@cm.ply", "--unit", "cm"}).exit_code, 0);
  const auto height = [this](const char* name) {
    double top = 0;
    for (const Vec3& p : read_surface(path(name)).mesh.vertices) top = std::max(top, p.z());
    return top;
  };
  EXPECT_NEAR(height("cm.ply"), 10 * height("mm.ply"), 0.5);
}

}  // namespace
}  // namespace vmesh::testing

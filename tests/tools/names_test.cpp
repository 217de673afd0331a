#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"
#include "vmesh/io/volume_io.h"
#include "vmesh/mesh/find_attribute.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using nlohmann::json;

/// A small tree with ends at three of its nodes.
class Names : public CommandTest {
 protected:
  Names() {
    write_y("y.swc");
    const Outcome run = vmesh({"generate", "@y.swc", "@plain.vtp", "--ends", "flat", "--json", "@plain.json"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const json summary = json::parse(read("plain.json"));
    for (const json& cap : summary.at("caps")) {
      nodes_.push_back(cap.at("node").get<Index>());
      centers_.push_back(cap.at("center").get<std::array<double, 3>>());
    }
  }

  std::string at(std::size_t end, const std::string& name) const { return std::to_string(nodes_.at(end)) + "=" + name; }

  /// The node and name of every cap in a summary.
  std::map<Index, std::string> caps(const std::string& name) const {
    std::map<Index, std::string> names;
    const json summary = json::parse(read(name));
    for (const json& cap : summary.at("caps")) names[cap.at("node").get<Index>()] = cap.at("name").get<std::string>();
    return names;
  }

  std::string refused(const std::vector<std::string>& options, int exit_code) const {
    std::vector<std::string> arguments = {"generate", "@y.swc", "@refused.vtp", "--ends", "flat"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_FALSE(exists("refused.vtp"));
    return run.err;
  }

  std::vector<Index> nodes_;
  std::vector<std::array<double, 3>> centers_;
};

void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST_F(Names, EndsHaveNamesOfTheirOwnOrOfTheirNumbers) {
  EXPECT_EQ(read_surface(path("plain.vtp")).attributes.patch_names,
            (std::vector<std::string>{"wall", "cap_1", "cap_2", "cap_3"}));
  const Outcome run = vmesh({"generate", "@y.swc", "@y.vtp", "--ends", "flat", "--flow-extensions", "2", "--name",
                             at(1, "inlet"), "--json", "@y.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_surface(path("y.vtp")).attributes.patch_names,
            (std::vector<std::string>{"wall", "cap_1", "inlet", "cap_3"}));
  EXPECT_EQ(caps("y.json"),
            (std::map<Index, std::string>{{nodes_[0], "cap_1"}, {nodes_[1], "inlet"}, {nodes_[2], "cap_3"}}));
}

TEST_F(Names, TablesNameNodesOrTheNearestEnds) {
  write("nodes.csv", "node, name # of ends\n" + std::to_string(nodes_[2]) + ", left\n\n");
  const auto& [x, y, z] = centers_[1];
  write("places.csv",
        "x,y,z,name\n" + std::to_string(x + 0.01) + "," + std::to_string(y) + "," + std::to_string(z) + ",right\n");
  for (const auto& [table, node, name] :
       {std::tuple("@nodes.csv", nodes_[2], "left"), {"@places.csv", nodes_[1], "right"}}) {
    const Outcome run = vmesh({"generate", "@y.swc", "@y.vtp", "--ends", "flat", "--names", table, "--name",
                               at(0, "trunk"), "--json", "@y.json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(caps("y.json").at(node), name);
    EXPECT_EQ(caps("y.json").at(nodes_[0]), "trunk");
  }
}

TEST_F(Names, GoFromFileToFile) {
  const std::vector<std::string> names = {"wall", "inlet", "cap_2", "out"};
  ASSERT_EQ(vmesh({"generate", "@y.swc", "@y.ply", "--ends", "flat", "--name", at(0, "inlet"), "--name", at(2, "out")})
                .exit_code,
            0);
  EXPECT_EQ(read_surface(path("y.ply")).attributes.patch_names, names);
  ASSERT_EQ(vmesh({"convert", "@y.ply", "@y.obj"}).exit_code, 0);
  ASSERT_EQ(vmesh({"convert", "@y.obj", "@y.stl", "--ascii"}).exit_code, 0);
  ASSERT_EQ(vmesh({"convert", "@y.stl", "@y.vtp", "--space", "LPS", "--unit", "mm"}).exit_code, 0);
  EXPECT_EQ(read_surface(path("y.vtp")).attributes.patch_names, names);
  write("scene.json", R"({"schema": "vmesh.scene/1", "duration_s": 0.02, "step_s": 0.01, "clamp": [0]})");
  const Outcome run = vmesh({"deform", "@y.swc", "@y.ply", "--script", "@scene.json", "-o", "@frames"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_surface(path("frames/frame_000000.vtp")).attributes.patch_names, names);
}

TEST_F(Names, SurviveAFit) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "@y.ply", "--ends", "flat", "--name", at(0, "inlet"), "--name", at(2, "out"),
                   "--flow-extensions", "2"})
                .exit_code,
            0);
  LoadedSurface scan = read_surface(path("plain.vtp"));
  for (Vec3& p : scan.mesh.vertices) p = Vec3(1.1 * p.x(), p.y(), p.z());
  write_surface(path("scan.stl"), scan.mesh);
  const Outcome run = vmesh({"fit", "@y.ply", "@scan.stl", "--reference-unit", "mm", "--reference-space", "LPS",
                             "--centerline", "@y.swc", "-o", "@fitted.vtp"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const LoadedSurface fitted = read_surface(path("fitted.vtp"));
  EXPECT_EQ(fitted.attributes.patch_names, (std::vector<std::string>{"wall", "inlet", "cap_2", "out"}));
  const MeshAttribute* number = find_attribute(fitted.attributes.face, "ModelFaceID");
  const MeshAttribute* cap = find_attribute(fitted.attributes.face, "CapID");
  ASSERT_NE(number, nullptr);
  ASSERT_NE(cap, nullptr);
  std::map<double, double> cap_of_number;
  for (std::size_t f = 0; f < number->values.size(); ++f) cap_of_number[number->values[f]] = cap->values[f];
  EXPECT_EQ(cap_of_number, (std::map<double, double>{{1, -1}, {2, 1}, {3, 2}, {4, 3}}));
  const Outcome volume = vmesh({"volume", "@fitted.vtp", "-o", "@y.vtu", "--wall-thickness", "0.2", "--wall-only"});
  ASSERT_EQ(volume.exit_code, 0) << volume.err;
  const std::vector<std::string> patches = read_volume(path("y.vtu")).mesh.patch_names;
  EXPECT_NE(std::find(patches.begin(), patches.end(), "out_wall"), patches.end());
}

TEST_F(Names, ArePatchesOfVolumes) {
  const Outcome run = vmesh({"volume", "@y.swc", "@y.vtu", "--name", at(0, "inlet")});
  if (run.err.find("without TetGen") != std::string::npos) GTEST_SKIP() << "built without TetGen";
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_volume(path("y.vtu")).mesh.patch_names, (std::vector<std::string>{"wall", "inlet", "cap_2", "cap_3"}));
  ASSERT_EQ(vmesh({"volume", "@y.swc", "-o", "@polyMesh", "--output-unit", "m"}).exit_code, 0);
  ASSERT_EQ(vmesh({"volume", "@y.swc", "-o", "@polyMesh", "--output-unit", "m"}).exit_code, 0) << "a mesh is replaced";
  const Outcome refused = vmesh({"volume", "@y.swc", "-o", "@mesh-complete"});
  EXPECT_EQ(refused.exit_code, 4);
  expect_in(refused.err, "SimVascular holds no wedges");
  ASSERT_EQ(vmesh({"volume", "@y.swc", "-o", "@mesh-complete", "--tetrahedra"}).exit_code, 0);
  EXPECT_TRUE(exists("mesh-complete/mesh-surfaces/cap_3.vtp"));
}

TEST_F(Names, AreInSimVascularsModels) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@model.mdl", "--ends", "flat", "--name", at(0, "inlet"),
                   "--output-unit", "cm"})
                .exit_code,
            0);
  expect_in(read("model.mdl"), "<face id=\"2\" name=\"inlet\" type=\"cap\"");
  expect_in(read("model.vtp.facenames"), "set gPolyDataFaceNames(2) {inlet}");
  EXPECT_EQ(read_surface(path("model.vtp")).unit, LengthUnit::cm);
  // What lies beside it is an output too.
  const Outcome over = vmesh({"convert", "@plain.vtp", "-o", "@plain.mdl"});
  EXPECT_EQ(over.exit_code, 2);
  expect_in(over.err, "plain.vtp: would be written with");
  EXPECT_FALSE(exists("plain.mdl"));
  EXPECT_EQ(vmesh({"convert", "@plain.vtp", "-o", "@m.mdl", "--attributes", "none"}).exit_code, 2);
  EXPECT_FALSE(exists("m.mdl"));
}

TEST_F(Names, ThatAreNoneAreRefused) {
  expect_in(refused({"--name", "999=inlet"}, 3), "--name 999=inlet: there is no node 999; the nodes are 0 to ");
  expect_in(refused({"--name", "inlet"}, 3), "give a node and a name: 3=inlet");
  expect_in(refused({"--name", "x=inlet"}, 3), "\"x\" is not a node number");
  expect_in(refused({"--name", at(0, "")}, 3), "\"\" cannot be the name of a patch");
  expect_in(refused({"--name", at(0, "in let")}, 3), "cannot be the name of a patch");
  expect_in(refused({"--name", at(0, "a"), "--name", at(1, "A")}, 3), "two patches have the name \"A\"");
  expect_in(refused({"--name", at(0, "a"), "--name", at(0, "b")}, 3), "is named twice");
  expect_in(refused({"--name", at(0, "Wall")}, 3), "cannot be called \"Wall\"");
  expect_in(refused({"--name", at(0, "wall_inlet")}, 3), "names begin with \"wall\" are walls");
  expect_in(refused({"--name", at(0, "cap_2")}, 3), "two patches have the name \"cap_2\"");
  write("t.csv", "x,y,z,name\n1000,0,0,far\n");
  expect_in(refused({"--names", "@t.csv"}, 3), "t.csv: line 2: no end is near (1000, 0, 0) mm: the nearest, at node ");
  write("t.csv", "id,name\n1,far\n");
  expect_in(refused({"--names", "@t.csv"}, 3), "t.csv: line 1: the columns are node,name or x,y,z,name");
  write("t.csv", "node,name\n1\n");
  expect_in(refused({"--names", "@t.csv"}, 3), "t.csv: line 2: there are 2 columns in the header, 1 here");
  const Outcome round = vmesh({"generate", "@y.swc", "@refused.vtp", "--name", at(0, "inlet")});
  EXPECT_EQ(round.exit_code, 2);
  expect_in(round.err, "--name and --names are for ends that are not round");
  // A node within a vessel, or where vessels branch.
  Index inner = 0;
  while (std::find(nodes_.begin(), nodes_.end(), inner) != nodes_.end()) ++inner;
  expect_in(refused({"--name", std::to_string(inner) + "=a"}, 3), "is no end of the centerline");
}

}  // namespace
}  // namespace vmesh::testing

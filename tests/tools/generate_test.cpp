#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

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

  // The surface of y.swc made by the command that the run announces; y.ply is where it wrote its own.
  std::string same_again(const Outcome& run) {
    const std::string announced =
        "the same again: vmesh generate " + path("y.swc").string() + " -o " + path("y.ply").string() + " ";
    const std::size_t at = run.err.find(announced);
    if (at == std::string::npos) return "not announced: " + run.err;
    std::istringstream line(run.err.substr(at + announced.size(), run.err.find('\n', at) - at - announced.size()));
    std::vector<std::string> command = {"generate", "@y.swc", "-o", "@again.ply"};
    for (std::string word; line >> word;) command.push_back(word);
    const Outcome again = vmesh(command);
    return again.exit_code == 0 ? read("again.ply") : again.err;
  }
};

TEST_F(Generate, WritesEverySurfaceFormat) {
  std::vector<std::string> names = {"y.ply", "y.stl", "y.obj", "y.off", "y.vtp"};
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
    if (attribute.name == "red" || attribute.name == "green" || attribute.name == "blue") {
      EXPECT_TRUE(*low >= 0 && *high <= 255 && *high > *low) << attribute.name;
      continue;
    }
    const double most = attribute.name == "segment" || attribute.name == "branch" ? 2
                        : attribute.name == "parameter"                           ? 1
                                                                                  : 3 + 1e-9;
    EXPECT_GE(*low, attribute.name == "radius" || attribute.name == "quality" ? 2.1 - 1e-9 : 0) << attribute.name;
    EXPECT_LE(*high, most) << attribute.name;
  }
  for (const char* name : {"radius", "segment", "parameter", "branch"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  ASSERT_EQ(surface.attributes.face.size(), 2u);
  EXPECT_EQ(surface.attributes.face[0].name, "EquiangleSkewness");
}

TEST_F(Generate, FacesKnowTheirBranch) {
  std::vector<std::string> names = {"y.ply", "y.vtp"};
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

/// The JSON of a .glb, whose sizes are checked.
json glb_json(const std::string& file) {
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8u | static_cast<unsigned char>(file.at(at + i));
    return std::size_t{value};
  };
  EXPECT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), file.size());
  EXPECT_EQ(file.substr(16, 4), "JSON");
  const std::size_t text = word(12);
  EXPECT_EQ(file.substr(24 + text, 4), std::string("BIN\0", 4));
  EXPECT_EQ(28 + text + word(20 + text), file.size());
  return json::parse(file.substr(20, text));
}

TEST_F(Generate, WritesGlbWithColorsAndBones) {
  for (const bool bones : {false, true}) {
    std::vector<std::string> arguments = {"generate", "@y.swc", "@y.glb", "--json", "@y.json"};
    if (bones) arguments.push_back("--bones");
    const Outcome run = vmesh(arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json glb = glb_json(read("y.glb"));
    const std::size_t vertices = json::parse(read("y.json")).at("vertices");
    const json& primitive = glb.at("meshes").at(0).at("primitives").at(0);
    const json& attributes = primitive.at("attributes");
    for (const char* name : {"POSITION", "NORMAL", "COLOR_0", "_RADIUS", "_SEGMENT", "_PARAMETER", "_BRANCH"})
      EXPECT_EQ(glb.at("accessors").at(attributes.at(name).get<std::size_t>()).at("count"), vertices) << name;
    EXPECT_EQ(attributes.contains("JOINTS_0") && attributes.contains("WEIGHTS_0"), bones);
    EXPECT_EQ(glb.contains("skins"), bones);
    // Three for each of the three segments, and the root's.
    EXPECT_EQ(glb.at("nodes").size(), bones ? 12u : 1u);
    for (const json& view : glb.at("bufferViews"))
      EXPECT_LE(view.at("byteOffset").get<std::size_t>() + view.at("byteLength").get<std::size_t>(),
                glb.at("buffers").at(0).at("byteLength").get<std::size_t>());
  }
  EXPECT_EQ(vmesh({"generate", "@y.swc", "@z.ply", "--bones"}).exit_code, 2);
  EXPECT_EQ(vmesh({"generate", "@y.swc", "@z.glb", "--output-unit", "cm"}).exit_code, 2);
  EXPECT_FALSE(exists("z.ply") || exists("z.glb"));
}

TEST_F(Generate, CapsEndsForFlow) {
  const std::string name = "y.vtp";
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@" + name, "--ends", "flat", "--flow-extensions", "3",
                             "--json", "@y.json", "--check"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const LoadedSurface surface = read_surface(path(name));
  ASSERT_EQ(surface.attributes.face.size(), 4u);
  const auto &face = surface.attributes.face[2], &cap = surface.attributes.face[3];
  EXPECT_EQ(face.name, "ModelFaceID");
  EXPECT_EQ(cap.name, "CapID");
  EXPECT_TRUE(face.integer && cap.integer);
  const json caps = json::parse(read("y.json")).at("caps");
  ASSERT_EQ(caps.size(), 3u);
  for (const json& listed : caps) {
    double area = 0;
    for (Index f = 0; f < surface.mesh.faces.size(); ++f) {
      if (face.values[f] != listed.at("model_face_id").get<double>()) continue;
      EXPECT_EQ(cap.values[f], listed.at("cap_id").get<double>());
      area += area_normal(surface.mesh, f).norm() / 2;
    }
    EXPECT_NEAR(area, listed.at("area_mm2").get<double>(), 1e-9 * area);
  }
  for (Index f = 0; f < surface.mesh.faces.size(); ++f) EXPECT_EQ(face.values[f] == 1, cap.values[f] == -1);
}

TEST_F(Generate, TellsWhichFlowExtensionHasNoRoom) {
  write("crossing.swc", "# SPACE=LPS\n# UNIT=mm\n1 0 -10 0 0 1 -1\n2 0 0 0 0 1 1\n3 0 6 -12 0 2 -1\n4 0 6 12 0 2 3\n");
  const Outcome refused = vmesh({"generate", "@crossing.swc", "@a.ply", "--ends", "flat", "--flow-extensions", "5"});
  EXPECT_EQ(refused.exit_code, 7) << refused.err;
  for (const char* part : {"the flow extension at node 3, 5 radii long, runs into the vessel of branch 0",
                           "radii fit there", "--flow-extensions auto"})
    EXPECT_NE(refused.err.find(part), std::string::npos) << refused.err;
  EXPECT_FALSE(exists("a.ply"));
  const Outcome run = vmesh({"generate", "@crossing.swc", "@a.ply", "--ends", "flat", "--flow-extensions", "auto",
                             "--check", "--json", "@a.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json summary = json::parse(read("a.json"));
  EXPECT_EQ(summary.at("options").at("flow_extensions"), "auto");
  for (const json& cap : summary.at("caps")) {
    const double length = cap.at("extension_radii");
    EXPECT_TRUE(cap.at("node") == 3 ? length > 3 && length < 4 : length == 10) << cap;
  }
  for (const char* wrong : {"-1", "long", "2000", "nan"})
    EXPECT_EQ(vmesh({"generate", "@crossing.swc", "@b.ply", "--ends", "flat", "--flow-extensions", wrong}).exit_code,
              2);
}

TEST_F(Generate, LeavesEndsOpenBesideFlatOnes) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "--ends", "flat", "--open-ends", "0", "--json", "@y.json"})
                .exit_code,
            0);
  std::size_t open = 0;
  const json summary = json::parse(read("y.json"));
  for (const json& cap : summary.at("caps")) {
    EXPECT_EQ(cap.at("capped"), cap.at("node") != 0);
    open += cap.at("capped").get<bool>() ? 0 : 1;
  }
  EXPECT_EQ(open, 1u);
  EXPECT_EQ(vmesh({"generate", "@y.swc", "-o", "@z.ply", "--ends", "flat", "--open-ends", "1"}).exit_code, 3);
  EXPECT_EQ(vmesh({"generate", "@y.swc", "-o", "@z.ply", "--flow-extensions", "3"}).exit_code, 2);
  EXPECT_FALSE(exists("z.ply"));
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

TEST_F(Generate, ABudgetSaysHowToHaveTheSameAgain) {
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.ply", "--budget", "vertices=400", "--json", "@y.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json budget = json::parse(read("y.json")).at("budget");
  EXPECT_TRUE(budget.at("met"));
  EXPECT_GE(budget.at("tried").size(), 3u);
  EXPECT_LE(json::parse(read("y.json")).at("vertices"), 400);
  EXPECT_EQ(same_again(run), read("y.ply"));
}

TEST_F(Generate, ABudgetOfVerticesWithLongTrianglesSaysHowToHaveTheSameAgain) {
  const Outcome run = vmesh(
      {"generate", "@y.swc", "-o", "@y.ply", "--budget", "vertices=100", "--elongation", "16", "--json", "@y.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json::parse(read("y.json")).at("vertices"), 100);
  EXPECT_NE(run.err.find(" --least-vertices 100 "), std::string::npos) << run.err;
  EXPECT_EQ(same_again(run), read("y.ply"));
}

TEST_F(Generate, LeastVerticesNeedWhatLeavesVerticesOut) {
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{}, {"--max-error", "10%"}, {"--elongation", "4", "--deformable"}}) {
    std::vector<std::string> command = {"generate", "@y.swc", "-o", "@y.ply", "--least-vertices", "100"};
    command.insert(command.end(), other.begin(), other.end());
    const Outcome run = vmesh(command);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_NE(run.err.find("--least-vertices needs --elongation above 1, and no --deformable"), std::string::npos)
        << run.err;
  }
}

TEST_F(Generate, ABudgetThatNothingKeepsIsAnErrorOfItsOwn) {
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.ply", "--budget", "vertices=5"});
  EXPECT_EQ(run.exit_code, 6);
  EXPECT_NE(run.err.find("nothing is within the budget vertices=5"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(" vertices here at the least; --elongation 4 leaves out"), std::string::npos) << run.err;
  EXPECT_TRUE(std::filesystem::exists(path("y.ply")));
}

TEST_F(Generate, ABudgetChoosesTheResolutionItself) {
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"--around", "8"}, {"--preset", "high"}, {"--max-error", "5%"}}) {
    std::vector<std::string> command = {"generate", "@y.swc", "-o", "@y.ply", "--budget", "vertices=500"};
    command.insert(command.end(), other.begin(), other.end());
    EXPECT_EQ(vmesh(command).exit_code, 2) << other.front();
  }
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.ply", "--budget", "faces=5"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("vertices=5000"), std::string::npos) << run.err;
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

// Two vessels across each other, their axes `distance` apart where the third and the fourth node of each meet.
class Overlap : public CommandTest {
 protected:
  void write_crossing(const std::string& distance) const {
    write("x.swc", "# SPACE=LPS\n# UNIT=mm\n1 0 -12 0 0 1 -1\n2 0 0 0 0 1 1\n3 0 12 0 0 1 2\n4 0 0 -12 " + distance +
                       " 0.9 -1\n5 0 0 1 " + distance + " 0.9 4\n6 0 0 12 " + distance + " 0.9 5\n");
  }
  json summary_of(const std::vector<std::string>& options, std::string* err = nullptr) const {
    std::vector<std::string> arguments = {"generate", "@x.swc", "-o", "@x.ply", "--json", "@x.json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    if (err) *err = run.err;
    return json::parse(read("x.json"));
  }
};

TEST_F(Overlap, IsToldAndKept) {
  write_crossing("1.2");
  std::string err;
  const json summary = summary_of({"--overlap", "keep", "--allow-defects"}, &err);
  EXPECT_EQ(summary.at("options").at("overlap"), "keep");
  EXPECT_EQ(summary.at("options").at("gap"), 0.1);
  const json& contacts = summary.at("contacts");
  EXPECT_EQ(contacts.at("count"), 1);
  const json& contact = contacts.at("list").at(0);
  EXPECT_NEAR(contact.at("depth_mm"), 0.7, 1e-6);
  EXPECT_NEAR(contact.at("depth_relative"), 0.7 / 0.9, 1e-6);
  EXPECT_NEAR(contact.at("at").at(2), (1 + 0.3) / 2, 1e-6);
  EXPECT_NE(contact.at("vessels").at(0).at("branch"), contact.at("vessels").at(1).at("branch"));
  EXPECT_FALSE(summary.contains("separation"));
  EXPECT_GT(summary.at("self_intersections"), 0);
  EXPECT_NE(err.find("touch in 1 place"), std::string::npos) << err;
  EXPECT_NE(err.find("--overlap separate"), std::string::npos) << err;
}

TEST_F(Overlap, IsRefusedWhenKept) {
  write_crossing("1.2");
  const Outcome run = vmesh({"generate", "@x.swc", "-o", "@x.ply", "--overlap", "keep", "--json", "@x.json"});
  EXPECT_EQ(run.exit_code, 7);
  EXPECT_FALSE(exists("x.ply"));
  EXPECT_FALSE(exists("x.json"));
  EXPECT_NE(run.err.find("crossing_faces: "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(", near line "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("on branch "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("--allow-defects"), std::string::npos) << run.err;

  const json summary = summary_of({"--overlap", "keep", "--allow-defects"});
  EXPECT_EQ(summary.at("sound"), false);
  const json& defect = summary.at("defects").at(0);
  EXPECT_EQ(defect.at("kind"), "crossing_faces");
  EXPECT_EQ(defect.at("count"), summary.at("self_intersections"));
  EXPECT_TRUE(defect.at("at").is_array() && defect.at("segment").is_number() && defect.at("branch").is_number());
  EXPECT_EQ(summary_of({}).at("sound"), true);
}

TEST_F(Overlap, IsSeparated) {
  for (const char* distance : {"1.1", "1.2", "1.95"}) {
    for (const char* gap : {"0.1", "0.3"}) {
      write_crossing(distance);
      std::string err;
      const json summary = summary_of({"--overlap", "separate", "--gap", gap, "--check"}, &err);
      EXPECT_EQ(summary.at("self_intersections"), 0);
      EXPECT_EQ(summary.at("contacts").at("count"), 1);
      const json& separation = summary.at("separation");
      EXPECT_EQ(separation.at("contacts_left").at("count"), 0);
      EXPECT_GT(separation.at("nodes_added"), 0);
      const double kept = std::atof(distance) / (1.9 + std::atof(gap) * 0.9);
      EXPECT_NEAR(separation.at("max_taken_relative"), 1 - kept, 0.03);
      EXPECT_NE(err.find("nodes were narrowed"), std::string::npos) << err;
      EXPECT_LT(summary.at("distance").at("max_relative"), 0.3);
      EXPECT_EQ(summary.at("distance").at("to"), "the narrowed vessels");
      const int left_out = summary.at("simplification").at("nodes_left_out");
      EXPECT_EQ(summary.at("nodes_inside"), 6 - left_out + separation.at("nodes_added").get<int>());
      EXPECT_EQ(summary.at("nodes_inside"), summary.at("nodes_inside_of").at("nodes"));
    }
  }
}

TEST_F(Overlap, IsNotSaidToBeNarrowedWhereNothingTouches) {
  write_crossing("2.5");
  const json summary = summary_of({});
  const bool simplified = summary.at("simplification").at("nodes_left_out") > 0;
  EXPECT_EQ(summary.at("contacts").at("count"), 0);
  EXPECT_EQ(summary.at("distance").at("to"), simplified ? "the simplified vessels" : "the vessels");
}

TEST_F(Overlap, SeparatedVerticesKeepTheirPlaceOnTheOriginalCenterline) {
  write_crossing("1.2");
  const json summary = summary_of({"--overlap", "separate"});
  EXPECT_EQ(summary.at("centerline").at("segments"), 4);
  const LoadedSurface surface = read_surface(path("x.ply"));
  const auto values = [&surface](const std::string& name) {
    for (const MeshAttribute& attribute : surface.attributes.vertex)
      if (attribute.name == name) return attribute.values;
    return std::vector<double>();
  };
  const auto segment = values("segment"), parameter = values("parameter"), radius = values("radius");
  ASSERT_EQ(segment.size(), surface.mesh.vertices.size());
  ASSERT_EQ(parameter.size(), surface.mesh.vertices.size());
  double least = 1;
  for (std::size_t v = 0; v < segment.size(); ++v) {
    EXPECT_LE(segment[v], 3);
    EXPECT_LE(parameter[v], 1);
    const Vec3& p = surface.mesh.vertices[v];
    const bool along_x = std::abs(p.y()) < 1.1 && p.z() < 1 - 0.35;  // not near the other vessel
    const double place = along_x ? p.x() : p.y();
    if (std::abs(place) < 5 || std::abs(place) > 11) continue;
    // Both vessels lie along their axes from -12 to 12, with a node near the middle.
    const double node = along_x ? 0 : 1;
    const double expected = place < node ? (place + 12) / (12 + node) : (place - node) / (12 - node);
    EXPECT_NEAR(std::min(std::abs(parameter[v] - expected), std::abs(1 - parameter[v] - expected)), 0, 0.06);
    least = std::min(least, radius[v]);
  }
  EXPECT_GT(least, 0.5);
}

TEST_F(Overlap, OfAxesThatCrossIsMovedApart) {
  for (const char* distance : {"0", "0.4"}) {
    write_crossing(distance);
    std::string err;
    const json summary = summary_of({"--overlap", "separate", "--check"}, &err);
    EXPECT_EQ(summary.at("self_intersections"), 0);
    const json& separation = summary.at("separation");
    EXPECT_EQ(separation.at("contacts_left").at("count"), 0);
    EXPECT_LE(separation.at("max_taken_relative"), 0.5);
    EXPECT_GT(separation.at("nodes_moved"), 3);
    EXPECT_LE(separation.at("steepest_move"), 0.5 + 1e-9);
    EXPECT_EQ(separation.at("moves").at("count"), 1);
    const json& move = separation.at("moves").at("list").at(0);
    EXPECT_NEAR(move.at("moved_mm"), 0.525 * 1.99 - std::atof(distance), 0.02);
    EXPECT_EQ(move.at("moved_mm"), separation.at("max_moved_mm"));
    EXPECT_NEAR(move.at("moved_relative"), move.at("moved_mm").get<double>() / 0.9, 1e-9);
    EXPECT_NEAR(move.at("vessel").at("radius_mm"), 0.9, 1e-12);
    EXPECT_EQ(summary.at("nodes_inside_of").at("centerline"), "the narrowed and moved vessels");
    EXPECT_EQ(summary.at("nodes_inside"), summary.at("nodes_inside_of").at("nodes"));
    EXPECT_NE(err.find("moved aside in 1 place"), std::string::npos) << err;
  }
}

// Two hubs in nearly one place, with more branches than there is room for beside each other.
TEST_F(Overlap, OfVesselsThatCannotBePartedIsNamed) {
  constexpr int kBranches = 20;
  const double turn = std::numbers::pi * (3 - std::sqrt(5));
  std::ostringstream swc;
  swc << "# SPACE=LPS\n# UNIT=mm\n";
  for (int hub = 0, id = 1; hub < 2; ++hub) {
    const int center = id++;
    swc << center << " 0 0 0 " << 0.01 * hub << " 0.5 -1\n";
    for (int k = 0; k < kBranches; ++k) {
      const double z = 1 - (2 * k + 1.0) / kBranches, across = std::sqrt(1 - z * z), angle = k * turn + 0.3 * hub;
      swc << id++ << " 0 " << 4 * across * std::cos(angle) << ' ' << 4 * across * std::sin(angle) << ' '
          << 4 * z + 0.01 * hub << " 0.5 " << center << '\n';
    }
  }
  write("x.swc", swc.str());
  std::string err;
  EXPECT_EQ(vmesh({"generate", "@x.swc", "-o", "@x.ply"}).exit_code, 7);
  EXPECT_FALSE(exists("x.ply"));
  const json summary = summary_of({"--overlap", "separate", "--allow-defects"}, &err);
  EXPECT_GT(summary.at("separation").at("contacts_left").at("count"), 0);
  EXPECT_NE(err.find("neither narrowing nor a small move can part them"), std::string::npos) << err;
}

TEST_F(Overlap, ValuesOutOfRangeAreRefused) {
  write_crossing("1.2");
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--overlap", "merge"}, {"--gap", "0"}, {"--gap", "1.1"}, {"--gap", "nan"}}) {
    std::vector<std::string> arguments = {"generate", "@x.swc", "-o", "@x.ply"};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    EXPECT_EQ(vmesh(arguments).exit_code, 2) << wrong[0];
  }
}

}  // namespace
}  // namespace vmesh::testing

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using nlohmann::json;

constexpr int kAround = 36, kRows = 61;
constexpr double kLength = 24, kWide = 2.4, kHigh = 1.9;

/// Where a plane through (x, 0, 0) cuts the wall of an elliptic vessel along x; it rises by `slope` per y.
std::vector<Vec3> loop(double x, double slope) {
  std::vector<Vec3> points;
  for (int i = 0; i < kAround; ++i) {
    const double turn = 2 * M_PI * i / kAround;
    points.emplace_back(x + slope * kWide * std::cos(turn), kWide * std::cos(turn), kHigh * std::sin(turn));
  }
  return points;
}

/// Tilted by 20 degrees at its beginning, straight at its end.
double slope_at(int row) { return 0.364 * (1 - row / (kRows - 1.0)); }

/// Half the sum of cross products, along the normal of a flat polygon.
Vec3 area_vector_of(const std::vector<Vec3>& polygon) {
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) area += polygon[i].cross(polygon[(i + 1) % polygon.size()]) / 2;
  return area;
}

/// The wall of a vessel that is open at both ends, and its centerline.
class FlatEnds : public CommandTest {
 protected:
  FlatEnds() {
    std::ostringstream off;
    off << "OFF\n" << kAround * kRows << " " << 2 * kAround * (kRows - 1) << " 0\n";
    for (int row = 0; row < kRows; ++row) {
      for (const Vec3& p : loop(kLength * row / (kRows - 1), slope_at(row))) off << p.transpose() << "\n";
    }
    for (int row = 0; row + 1 < kRows; ++row) {
      for (int i = 0; i < kAround; ++i) {
        const int a = row * kAround + i, b = row * kAround + (i + 1) % kAround;
        off << "3 " << a << " " << b << " " << b + kAround << "\n3 " << a << " " << b + kAround << " " << a + kAround
            << "\n";
      }
    }
    write("wall.off", off.str());
  }

  void extract(const std::string& name) const {
    const Outcome run = vmesh({"centerline", "@wall.off", "--unit", "mm", "--space", "LPS", "-o", "@" + name, "--json",
                               "@centerline_summary.json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err.find("flat ends are lost") != std::string::npos, name == "cut.swc") << run.err;
  }
};

TEST_F(FlatEnds, AreWrittenWithTheCenterline) {
  extract("cut.json");
  const json sections = json::parse(read("centerline_summary.json")).at("end_sections");
  ASSERT_EQ(sections.size(), 2u);
  const std::vector<EndSection> kept = read_centerline(path("cut.json")).end_sections;
  ASSERT_EQ(kept.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(sections[i].at("node"), kept[i].node);
    EXPECT_EQ(sections[i].at("area_mm2"), kept[i].area);
    EXPECT_EQ(sections[i].at("open"), true);
    EXPECT_EQ(kept[i].ring.size(), std::size_t{kAround});
    EXPECT_GT(kept[i].area, 0.99 * M_PI * kWide * kHigh);
  }
  extract("cut.swc");
  EXPECT_TRUE(read_centerline(path("cut.swc")).end_sections.empty());
}

TEST_F(FlatEnds, AreThoseOfTheSurface) {
  extract("cut.json");
  for (const bool fitted : {false, true}) {
    SCOPED_TRACE(fitted);
    std::vector<std::string> arguments = {"generate", "@cut.json", "@open.ply", "--ends",     "open",
                                          "--around", "12",        "--json",    "@open.json", "--check"};
    if (fitted)
      for (const char* argument : {"--fit", "@wall.off", "--reference-unit", "mm", "--reference-space", "LPS"})
        arguments.push_back(argument);
    const Outcome run = vmesh(arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const TriMesh mesh = read_surface(path("open.ply")).mesh;
    const json summary = json::parse(read("open.json"));
    ASSERT_EQ(summary.at("openings").size(), 2u);
    for (const json& opening : summary.at("openings")) {
      const bool at_begin = opening.at("center").at(0).get<double>() < kLength / 2;
      const std::vector<Vec3> wall = at_begin ? loop(0, slope_at(0)) : loop(kLength, 0);
      std::vector<Vec3> ring;
      for (const Index v : opening.at("vertices").get<std::vector<Index>>()) ring.push_back(mesh.vertices.at(v));
      const Vec3 area = area_vector_of(ring), area_of_wall = area_vector_of(wall);
      EXPECT_NEAR(area.norm(), area_of_wall.norm(), 1e-6 * area.norm());  // a text file's digits
      const Vec3 normal = area_of_wall.normalized();
      for (const Vec3& p : ring) EXPECT_NEAR(normal.dot(p - wall[0]), 0, 1e-5);
    }
    for (const json& end : summary.at("caps")) EXPECT_EQ(end.at("at_section"), true);
  }
}

/// The normals of the facets of every solid of an STL file.
std::map<std::string, std::vector<Vec3>> normals_of_solids(const std::string& content) {
  std::map<std::string, std::vector<Vec3>> solids;
  std::istringstream lines(content);
  std::string solid;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, normal;
    words >> word;
    if (word == "solid") words >> solid;
    Vec3 n;
    if (word == "facet" && words >> normal >> n.x() >> n.y() >> n.z()) solids[solid].push_back(n);
  }
  return solids;
}

TEST_F(FlatEnds, AreSolidsOfTheirOwn) {
  write_y("y.swc");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "@y.stl", "--ascii", "--ends", "flat", "--json", "@y.json"}).exit_code, 0);
  ASSERT_EQ(vmesh({"generate", "@y.swc", "@y.vtp", "--ends", "flat"}).exit_code, 0);
  const auto solids = normals_of_solids(read("y.stl"));
  const json caps = json::parse(read("y.json")).at("caps");
  ASSERT_EQ(caps.size(), 3u);
  ASSERT_EQ(solids.size(), 4u);
  std::map<double, std::size_t> faces_of;
  for (const MeshAttribute& a : read_surface(path("y.vtp")).attributes.face) {
    if (a.name == "CapID")
      for (const double id : a.values) ++faces_of[id];
  }
  EXPECT_EQ(solids.at("wall").size(), faces_of.at(-1));
  for (const json& cap : caps) {
    const int id = cap.at("cap_id").get<int>();
    const auto of_cap = solids.at("cap_" + std::to_string(id));
    EXPECT_EQ(of_cap.size(), faces_of.at(id));
    const auto normal = cap.at("normal").get<std::array<double, 3>>();
    for (const Vec3& n : of_cap) EXPECT_LT((n - Vec3(normal[0], normal[1], normal[2])).norm(), 1e-5);
  }
}

TEST_F(FlatEnds, AreIgnoredWhereEndsAreRound) {
  extract("cut.json");
  extract("cut.swc");
  for (const char* name : {"cut.json", "cut.swc"})
    ASSERT_EQ(
        vmesh({"generate", std::string("@") + name, std::string("@") + name + ".off", "--space", "LPS"}).exit_code, 0);
  const auto without_comments = [this](const std::string& name) {
    std::istringstream in(read(name));
    std::string text;
    for (std::string line; std::getline(in, line);)
      if (!line.starts_with("#")) text += line + "\n";
    return text;
  };
  EXPECT_EQ(without_comments("cut.json.off"), without_comments("cut.swc.off"));
}

TEST_F(FlatEnds, ThatCannotBeKeptAreTold) {
  extract("cut.json");
  json cut = json::parse(read("cut.json"));
  cut["end_sections"][0]["normal"] = {0, 1, 0};
  write("turned.json", cut.dump());
  const Outcome run = vmesh({"generate", "@turned.json", "@flat.ply", "--ends", "flat", "--json", "@flat.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string node = std::to_string(cut["end_sections"][0]["node"].get<int>());
  EXPECT_NE(run.err.find("the flat end at node " + node + " is not kept: its plane is"), std::string::npos) << run.err;
  const json caps = json::parse(read("flat.json")).at("caps");
  ASSERT_EQ(caps.size(), 2u);
  EXPECT_NE(caps[0].at("at_section"), caps[1].at("at_section"));
}

}  // namespace
}  // namespace vmesh::testing

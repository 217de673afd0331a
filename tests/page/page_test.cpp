// Pages contain the results, are self-contained, and escape names.
#include <algorithm>
#include <filesystem>
#include <regex>

#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"

#include "run_vmesh.h"
#include "unpack.h"

namespace vmesh::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// The data between their script tags.
Json data_of(const std::string& page) {
  const std::string begin = "id=\"page-data\">";
  const std::size_t from = page.find(begin) + begin.size();
  return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

std::vector<Vec3> points_of(const Json& json, const std::vector<std::int64_t>& places) {
  std::vector<Vec3> points;
  const double step = json["step"].get<double>();
  for (std::size_t i = 0; i + 2 < places.size(); i += 3) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = json["low"][axis].get<double>() + step * static_cast<double>(places[i + axis]);
    points.push_back(p);
  }
  return points;
}

std::vector<Triangle> faces_of(const Json& surface) {
  const std::vector<std::int64_t> c = unpack(surface["corners"].get<std::string>(), 3);
  std::vector<Triangle> faces;
  for (std::size_t i = 0; i + 2 < c.size(); i += 3) {
    const std::int64_t b = c[i] + c[i + 1];
    faces.push_back({static_cast<Index>(c[i]), static_cast<Index>(b), static_cast<Index>(b + c[i + 2])});
  }
  return faces;
}

const Json& named(const Json& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Json& a) { return a["name"] == name; });
  if (found == list.end()) throw std::runtime_error("there is no " + name);
  return *found;
}

/// Rounded by half a step, and by what doubles and the file's text do.
void expect_near(const std::vector<Vec3>& found, const std::vector<Vec3>& expected, double step) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_LE((found[i] - expected[i]).cwiseAbs().maxCoeff(), 0.501 * step) << i;
}

class Pages : public CommandTest {
 protected:
  Pages() { write_y("y.swc"); }

  Json page_of(const std::vector<std::string>& arguments, const std::string& name = "y.html") const {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"--html", "@" + name});
    const Outcome run = vmesh(all);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return data_of(read(name));
  }
};

TEST_F(Pages, HoldTheSurfaceThatWasWritten) {
  const Json page = page_of({"generate", "@y.swc", "-o", "@y.ply"});
  const LoadedSurface written = read_surface(path("y.ply"));
  const Json& surface = page["surfaces"][0];
  const double step = surface["step"].get<double>();
  expect_near(points_of(surface, unpack(surface["positions"].get<std::string>(), 3)), written.mesh.vertices, step);
  EXPECT_EQ(faces_of(surface), written.mesh.faces);
  std::size_t compared = 0;
  for (const MeshAttribute& a : written.attributes.vertex) {
    if (a.name != "radius" && a.name != "segment" && a.name != "parameter" && a.name != "branch") continue;
    const Json& found = named(surface["attributes"], a.name);
    const std::vector<std::int64_t> steps = unpack(found["values"].get<std::string>());
    ASSERT_EQ(steps.size(), a.values.size());
    const double size = found["step"].get<double>();
    for (std::size_t v = 0; v < steps.size(); ++v)
      EXPECT_NEAR(found["low"].get<double>() + size * static_cast<double>(steps[v]), a.values[v], 0.501 * size);
    ++compared;
  }
  EXPECT_EQ(compared, 4u);
  EXPECT_EQ(named(surface["attributes"], "EquiangleSkewness")["on"], "face");
  EXPECT_EQ(page["centerline"]["nodes"], 4);
}

TEST_F(Pages, NamePlacesDistributionsAndTheWayTheyWereMade) {
  const Json page = page_of({"generate", "@y.swc", "-o", "@y.ply", "--around", "8", "--json", "@y.json"});
  const Json summary = Json::parse(read("y.json"));
  EXPECT_EQ(page["title"], "y.ply");
  EXPECT_NE(page["command_line"].get<std::string>().find("--around 8"), std::string::npos);
  EXPECT_NE(page["options"].get<std::string>().find("--around 8"), std::string::npos);
  const Json& histogram = page["histograms"][0];
  std::size_t faces = 0;
  for (const Json& bin : histogram["counts"]) faces += bin.get<std::size_t>();
  EXPECT_EQ(faces, summary["faces"].get<std::size_t>());
  EXPECT_DOUBLE_EQ(histogram["max"].get<double>(), summary["skewness"]["max"].get<double>());
  ASSERT_GE(page["places"].size(), 3u);
  const Json& at = summary["distance"]["max_at"];
  EXPECT_EQ(page["places"][0]["at"], at);
  const std::string all = page.dump();
  EXPECT_EQ(all.find("seconds"), std::string::npos) << "differs from run to run";
}

TEST_F(Pages, AreTheSameEveryTime) {
  page_of({"generate", "@y.swc", "-o", "@y.ply"});
  const std::string first = read("y.html");
  page_of({"generate", "@y.swc", "-o", "@y.ply"});
  EXPECT_TRUE(first == read("y.html"));
}

TEST_F(Pages, StandAlone) {
  page_of({"generate", "@y.swc", "-o", "@y.ply"});
  const std::string page = read("y.html");
  EXPECT_EQ(page.rfind("<!doctype html>", 0), 0u);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  for (const char* loads : {"<script src", "<link", "@import", "url(", "<iframe"})
    EXPECT_EQ(page.find(loads), std::string::npos) << loads;
  for (const char* left : {"@TITLE@", "@STYLE@", "@DATA@", "@LICENSE@", "@THREE@", "@SCRIPT@"})
    EXPECT_EQ(page.find(left), std::string::npos) << left;
  std::vector<fs::path> parts = {VMESH_THREE_BUNDLE, VMESH_THREE_LICENSE};
  for (const fs::directory_entry& entry : fs::directory_iterator(VMESH_PAGE_SOURCES))
    if (const fs::path extension = entry.path().extension(); extension == ".js" || extension == ".css")
      parts.push_back(entry.path());
  EXPECT_GT(parts.size(), 10u);
  for (const fs::path& part : parts) EXPECT_NE(page.find(read_file(part)), std::string::npos) << part << " is in it";
}

TEST_F(Pages, LetNoNameBecomeMarkup) {
  page_of({"generate", "@y.swc", "-o", "@y.ply"}, "plain.html");
  fs::create_directory(path("a<"));
  fs::copy_file(path("y.swc"), path("a</script><img src=x onerror=alert(1)>.swc"));
  const std::string out = "<!--<script>@DATA@ & 'x'\xff.ply";
  const Json page = page_of({"generate", "@a</script><img src=x onerror=alert(1)>.swc", "-o", "@" + out});
  const std::string html = read("y.html"), plain = read("plain.html");
  for (const char* markup : {"</script>", "<script", "<!--", "<img"})
    EXPECT_EQ(count(html, markup), count(plain, markup)) << markup;
  EXPECT_EQ(page["title"], "<!--<script>@DATA@ & 'x'\xef\xbf\xbd.ply") << "repaired where it is not UTF-8";
  EXPECT_NE(html.find("<title>&lt;!--&lt;script&gt;@DATA@ &amp; 'x'"), std::string::npos);
  EXPECT_NE(page["command_line"].get<std::string>().find("a</script><img src=x onerror=alert(1)>.swc'"),
            std::string::npos);
}

TEST_F(Pages, ThatCannotBeWrittenAreRefusedAtOnce) {
  const auto refused = [&](const std::string& html, int exit_code) {
    const auto before = files();
    const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.ply", "--html", html});
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_EQ(files(), before);
  };
  refused("@y.txt", 4);
  refused("@none/y.html", 5);
  fs::copy_file(path("y.swc"), path("in.html"));
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@z.ply", "--json", "@z.html", "--html", "@z.html"});
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_FALSE(exists("z.html"));
}

TEST_F(Pages, OfAnEvaluationShowTheReferenceAndTheFarthestPoints) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "-q"}).exit_code, 0);
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@fine.ply", "--around", "14", "-q"}).exit_code, 0);
  const Json page =
      page_of({"evaluate", "@y.ply", "--reference", "@fine.ply", "--centerline", "@y.swc", "--json", "@e.json"});
  const Json report = Json::parse(read("e.json"));
  const LoadedSurface reference = read_surface(path("fine.ply"));
  const Json& shown = page["surfaces"][1];
  EXPECT_TRUE(shown["reference"].get<bool>());
  EXPECT_EQ(faces_of(shown), reference.mesh.faces);
  EXPECT_EQ(page["places"][0]["at"], report["reference"]["from_surface"]["farthest"]["at"]);
  EXPECT_EQ(page["places"][1]["at"], report["reference"]["from_reference"]["farthest"]["at"]);
  named(page["surfaces"][0]["attributes"], "distance");
  named(page["surfaces"][0]["attributes"], "volume_distance");
  EXPECT_EQ(page["tables"][0]["rows"][0][1], std::to_string(report["vertices"].get<std::size_t>()));
}

TEST_F(Pages, OfAFitShowWhatItWasFittedTo) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "-q"}).exit_code, 0);
  ASSERT_EQ(
      vmesh({"generate", "@y.swc", "-o", "@fine.ply", "--around", "14", "--placement", "inscribed", "-q"}).exit_code,
      0);
  const Json page =
      page_of({"fit", "@y.ply", "@fine.ply", "--centerline", "@y.swc", "-o", "@fitted.ply", "--json", "@f.json"});
  const Json summary = Json::parse(read("f.json"));
  EXPECT_EQ(page["surfaces"][0]["vertices"], summary["vertices"]);
  EXPECT_EQ(faces_of(page["surfaces"][1]), read_surface(path("fine.ply")).mesh.faces);
  EXPECT_EQ(page["places"][0]["at"], summary["fit"]["after"]["from_surface"]["farthest"]["at"]);
  const Json grown = page_of({"generate", "@y.swc", "--fit", "@fine.ply", "-o", "@z.ply"});
  EXPECT_EQ(grown["surfaces"].size(), 2u);
  named(grown["surfaces"][0]["attributes"], "distance");
}

TEST_F(Pages, OfAMotionHoldItsFrames) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "-q"}).exit_code, 0);
  write("scene.json", R"({"schema": "vmesh.scene/1", "duration_s": 0.2, "frame_every": 2, "fix": [0],
    "gravity_m_s2": [9.81, 0, 0]})");
  const Json page =
      page_of({"deform", "@y.swc", "@y.ply", "--script", "@scene.json", "-o", "@moved", "--format", "ply"});
  const Json &surface = page["surfaces"][0], &frames = page["frames"];
  ASSERT_EQ(frames["moves"].size(), 6u);
  EXPECT_NEAR(frames["time_s"].back().get<double>(), 0.2, 1e-12);
  std::vector<std::int64_t> places;
  for (const Json& packed : frames["moves"]) {
    const std::vector<std::int64_t> moves = unpack(packed.get<std::string>(), 3);
    places.resize(moves.size());
    for (std::size_t i = 0; i < moves.size(); ++i) places[i] += moves[i];
  }
  std::vector<Vec3> points = points_of(surface, places);
  const std::size_t vertices = surface["vertices"].get<std::size_t>();
  ASSERT_EQ(points.size(), vertices + 4) << "the nodes of the centerline come after them";
  points.resize(vertices);
  expect_near(points, read_surface(path("moved/frame_000005.ply")).mesh.vertices, surface["step"].get<double>());
}

TEST_F(Pages, OfComparisonsHoldEverySurfaceOrTheChart) {
  const Json table = page_of({"table2", "--centerline", "@y.swc", "--voxel", "1.5", "--samples", "2000"}, "t.html");
  ASSERT_GE(table["surfaces"].size(), 4u);
  EXPECT_TRUE(table["surfaces"].back()["reference"].get<bool>());
  for (const Json& surface : table["surfaces"]) named(surface["attributes"], "distance");
  const Json sweep = page_of({"tradeoff", "@y.swc", "--samples", "500", "--plot", "@plot.svg"}, "s.html");
  const std::string source = sweep["pictures"][0][1].get<std::string>(), kind = "data:image/svg+xml;base64,";
  ASSERT_EQ(source.rfind(kind, 0), 0u);
  EXPECT_EQ(from_base64(source.substr(kind.size())), read("plot.svg"));
}

}  // namespace
}  // namespace vmesh::testing

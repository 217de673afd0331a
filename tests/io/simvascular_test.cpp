#include <cmath>
#include <numbers>

#include "vmesh/io/centerline_io.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::expect_contains;
using testing::message_of;

std::string point(const char* tag, const Vec3& p) {
  char text[200];
  std::snprintf(text, sizeof text, "<%s id=\"0\" x=\"%.17g\" y=\"%.17g\" z=\"%.17g\" />", tag, p.x(), p.y(), p.z());
  return text;
}

/// A regular polygon around `center` in the plane of u and v, its corners `radius` away.
std::string contour(const Vec3& center, double radius, const Vec3& u, const Vec3& v, int corners) {
  std::string text = "<contour id=\"0\" type=\"Circle\" closed=\"true\"><path_point id=\"3\">" +
                     point("pos", center + Vec3(0.1, 0, 0)) + "</path_point><contour_points>";
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    text += point("point", center + radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return text + "</contour_points></contour>";
}

std::string group(const std::string& contours) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<format version=\"1.0\" />\n"
         "<contourgroup path_name=\"aorta\" path_id=\"1\"><timestep id=\"0\"><lofting_parameters />" +
         contours + "</timestep></contourgroup>";
}

std::string path(const std::string& points) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<format version=\"1.0\" />\n<path id=\"1\"><timestep id=\"0\">"
         "<path_element><control_points>" +
         point("point", {9, 9, 9}) + "</control_points><path_points>" + points +
         "</path_points></path_element></timestep></path>";
}

RawCenterline parse(const std::string& text, const CenterlineFormat& format = centerline_format("t.ctgr"),
                    const CenterlineReadOptions& options = {}) {
  return parse_centerline(text, format, "t", options);
}

TEST(ReadContours, AVesselIsAsWideAsItsContoursArea) {
  const Vec3 u = Vec3(1, 1, 0).normalized(), v = Vec3(0, 0, 1);
  const RawCenterline raw =
      parse(group(contour({1, 2, 3}, 2, u, v, 60) + "<contour id=\"1\" />" + contour({5, -2, 3}, 1, u, v, 4)));
  ASSERT_EQ(raw.nodes.size(), 2u);
  constexpr double kRounding = 1e-12;
  const auto polygon_radius = [](double radius, int n) {  // of the circle with a regular polygon's area
    return radius * std::sqrt(n * std::sin(2 * std::numbers::pi / n) / (2 * std::numbers::pi));
  };
  EXPECT_NEAR(raw.nodes[0].radius, polygon_radius(2, 60), kRounding);
  EXPECT_NEAR(raw.nodes[1].radius, polygon_radius(1, 4), kRounding);
  EXPECT_LE((raw.nodes[0].position - Vec3(1, 2, 3)).norm(), kRounding);
  EXPECT_LE((raw.nodes[1].position - Vec3(5, -2, 3)).norm(), kRounding);
  EXPECT_EQ(raw.name_of_node(1), "t: contour 2");
  EXPECT_EQ(raw.warnings.size(), 1u);  // of the contour without points
  EXPECT_EQ(raw.unit, LengthUnit::unknown);
}

TEST(ReadContours, TheCentreIsThatOfTheArea) {
  // Corners crowd on one side of a square; their mean lies off its middle.
  std::string corners;
  for (const Vec3& p : {Vec3(1, 1, 0), Vec3(-1, 1, 0), Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, -.5, 0), Vec3(1, 0, 0)})
    corners += point("point", p);
  const std::string one = "<contour><contour_points>" + corners + "</contour_points></contour>";
  const RawCenterline raw = parse(group(one + contour({0, 0, 5}, 1, {1, 0, 0}, {0, 1, 0}, 8)));
  EXPECT_LE(raw.nodes[0].position.norm(), 1e-12);
  EXPECT_NEAR(raw.nodes[0].radius, std::sqrt(4 / std::numbers::pi), 1e-12);
}

TEST(ReadContours, NamesWhatIsWrong) {
  const std::string good = contour({0, 0, 0}, 1, {1, 0, 0}, {0, 1, 0}, 4);
  std::string bad = contour({0, 0, 5}, 1, {1, 0, 0}, {0, 1, 0}, 4);
  bad.replace(bad.rfind("z=\"5\""), 5, "z=\"v\"");
  const auto error = [](const std::string& text) { return message_of<InvalidInput>([&] { parse(text); }); };
  expect_contains(error(group(good + bad)), "t: contour 1, contour point 3: its z=\"v\"");
  expect_contains(error(group(good)), "fewer than two");
  expect_contains(error(path("")), "no <contourgroup>");
  expect_contains(error("<contourgroup/>"), "no <timestep>");
}

TEST(ReadPath, NeedsARadius) {
  const std::string text = path("<path_point id=\"0\">" + point("pos", {1, 2, 3}) + point("tangent", {0, 0, 1}) +
                                "</path_point><path_point id=\"1\">" + point("pos", {1, 2, 7}) + "</path_point>");
  expect_contains(message_of<InvalidInput>([&] { parse(text, centerline_format("t.pth")); }), "--radius");
  CenterlineReadOptions options;
  options.radius = 4;
  std::vector<std::string> warnings;
  const RawCenterline raw =
      convert_read(parse(text, centerline_format("t.pth"), options), options, LengthUnit::cm, {}, warnings);
  ASSERT_EQ(raw.nodes.size(), 2u);
  EXPECT_EQ(raw.nodes[1].position, Vec3(10, 20, 70));
  EXPECT_EQ(raw.nodes[1].radius, 4);  // mm, whatever the file's unit
  EXPECT_EQ(raw.segments.size(), 1u);
  expect_contains(message_of<InvalidInput>([&] { parse(path("<path_point/>"), centerline_format("t.pth"), options); }),
                  "path point 0: its x=\"\" is not a number");
}

}  // namespace
}  // namespace vmesh

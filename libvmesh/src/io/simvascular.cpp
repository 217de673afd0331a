// Paths and contour groups of SimVascular.
#include <cmath>
#include <numbers>

#include "formats.h"
#include "text.h"
#include "xml.h"

namespace vmesh::io {
namespace {

[[noreturn]] void fail(const std::string& source, const std::string& what) { throw InvalidInput(source + ": " + what); }

double coordinate(pugi::xml_node node, const char* axis, const std::string& source, const std::string& place) {
  const std::string_view text = node.attribute(axis).value();
  const auto value = parse_double(text);
  if (!value) fail(source, place + ": its " + axis + "=" + cite(text) + " is not a number");
  return *value;
}

Vec3 position(pugi::xml_node node, const std::string& source, const std::string& place) {
  return {coordinate(node, "x", source, place), coordinate(node, "y", source, place),
          coordinate(node, "z", source, place)};
}

/// The first time step of the path or contour group; warns when there are more.
pugi::xml_node first_step(pugi::xml_node owner, RawCenterline& raw) {
  const pugi::xml_node step = owner.child("timestep");
  if (!step) fail(raw.source, "it contains no <timestep>");
  if (step.next_sibling("timestep"))
    raw.warnings.push_back(raw.source + ": there is more than one time step; the first is used");
  return step;
}

/// Joins the added nodes in a row, as one vessel.
void join_in_a_row(RawCenterline& raw, const std::string& what) {
  if (raw.nodes.size() < 2) fail(raw.source, "there are fewer than two " + what + " in it");
  raw.path_starts.push_back(0);
  for (Index n = 1; n < raw.nodes.size(); ++n) raw.segments.push_back({n - 1, n});
}

/// Centre of area and area of a closed polygon that is nearly plane.
struct Section {
  Vec3 center = Vec3::Zero();
  double area = 0;
};

Section section_of(const std::vector<Vec3>& corners) {
  Vec3 mean = Vec3::Zero(), normal = Vec3::Zero();
  for (const Vec3& p : corners) mean += p / static_cast<double>(corners.size());
  const auto next = [&](std::size_t i) { return corners[(i + 1) % corners.size()] - mean; };
  for (std::size_t i = 0; i < corners.size(); ++i) normal += 0.5 * (corners[i] - mean).cross(next(i));
  const double area = normal.norm();
  if (!(area > 0)) return {mean, 0};
  Vec3 center = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 corner = corners[i] - mean;
    const double share = 0.5 * corner.cross(next(i)).dot(normal) / (area * area);
    center += share * (corner + next(i)) / 3;
  }
  return {mean + center, area};
}

void add_contour(pugi::xml_node contour, std::size_t number, RawCenterline& raw) {
  const std::string place = "contour " + std::to_string(number);
  std::vector<Vec3> corners;
  for (const pugi::xml_node point : contour.child("contour_points").children("point"))
    corners.push_back(position(point, raw.source, place + ", contour point " + std::to_string(corners.size())));
  if (corners.size() < 3) {
    raw.warnings.push_back(raw.source + ": " + place + " has fewer than three contour points; left out");
    return;
  }
  const Section section = section_of(corners);
  raw.nodes.push_back({section.center, std::sqrt(section.area / std::numbers::pi)});
  raw.node_numbers.push_back(number);
}

RawCenterline of_kind(const std::string& source, const char* node_word) {
  RawCenterline raw;
  raw.source = source;
  raw.node_word = node_word;
  raw.loose_branches = true;
  return raw;
}

}  // namespace

RawCenterline parse_contours(std::string_view content, const std::string& source, const CenterlineReadOptions&) {
  const XmlFile file = parse_xml(content, source);
  const pugi::xml_node group = file.document.child("contourgroup");
  if (!group) fail(source, "this is not a contour group of SimVascular: it contains no <contourgroup>");
  RawCenterline raw = of_kind(source, "contour");
  std::size_t number = 0;
  for (const pugi::xml_node contour : first_step(group, raw).children("contour")) add_contour(contour, number++, raw);
  join_in_a_row(raw, "contours with points");
  return raw;
}

RawCenterline parse_path(std::string_view content, const std::string& source, const CenterlineReadOptions& options) {
  const XmlFile file = parse_xml(content, source);
  const pugi::xml_node path = file.document.child("path");
  if (!path) fail(source, "this is not a path of SimVascular: it contains no <path>");
  if (!options.radius) {
    fail(source,
         "a path holds no radii: give the contour group of the same name (.ctgr), or one radius for all with --radius");
  }
  RawCenterline raw = of_kind(source, "path point");
  const pugi::xml_node points = first_step(path, raw).child("path_element").child("path_points");
  for (const pugi::xml_node point : points.children("path_point")) {
    const std::string place = "path point " + std::to_string(raw.nodes.size());
    raw.nodes.push_back({position(point.child("pos"), source, place), 0});
  }
  join_in_a_row(raw, "path points");
  return raw;
}

}  // namespace vmesh::io

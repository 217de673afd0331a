#include "page/live/live_page.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "command_line/outputs.h"
#include "command_line/quoting.h"
#include "page/filling.h"
#include "page/live/live_parts.h"
#include "page/packing.h"
#include "report/json.h"

namespace vmesh::tool {
namespace {

static_assert(std::endian::native == std::endian::little, "pages have numbers as browsers have them in memory");

/// Numbers as in memory, in base64.
template <class Number>
std::string raw(const std::vector<Number>& numbers) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(numbers.data());
  return base64({bytes, numbers.size() * sizeof(Number)});
}

std::string raw(const std::vector<Vec3>& points) {
  std::vector<double> numbers;
  for (const Vec3& p : points) numbers.insert(numbers.end(), {p[0], p[1], p[2]});
  return raw(numbers);
}

Json contact_of(const ContactOptions& contact) {
  return {{"self", contact.self},
          {"gap_ratio", contact.gap_ratio},
          {"friction", contact.friction},
          {"iterations", contact.iterations},
          {"slip_radii_per_s", contact.slip_radii_per_s}};
}

Json tissue_of(const TissueProperties& tissue) {
  const Json tear = std::isfinite(tissue.tear_N_mm) ? Json(tissue.tear_N_mm) : Json(nullptr);
  return {{"stiffness_N_mm2", tissue.stiffness_N_mm2}, {"tear_N_mm", tear}};
}

Json settings_of(const LivePage& page) {
  const Material& m = page.material;
  Json material = {{"young_Pa", m.young_Pa},
                   {"density_kg_m3", m.density_kg_m3},
                   {"poisson_ratio", m.poisson_ratio},
                   {"damping_s", m.damping_s}};
  // A scene has one of the two.
  if (m.wall_mm > 0)
    material["wall_mm"] = m.wall_mm;
  else
    material["wall_ratio"] = m.wall_ratio;
  const SimulationOptions& o = page.options;
  const Vec3 gravity = o.gravity_mm_s2 / 1e3;
  return {{"material", material},
          {"step_s", o.step_s},
          {"iterations", o.iterations},
          {"gravity_m_s2", {gravity[0], gravity[1], gravity[2]}},
          {"drag_per_s", o.drag_per_s},
          {"squeeze_response_s", o.squeeze_response_s},
          {"fix", page.fix},
          {"clamp", page.clamp},
          {"contact", page.contact ? contact_of(*page.contact) : Json(nullptr)},
          {"tissue", page.tissue ? tissue_of(*page.tissue) : Json(nullptr)}};
}

void add_tree(const Centerline& centerline, Json& json) {
  std::vector<Vec3> positions;
  std::vector<double> radii;
  for (const CenterlineNode& node : centerline.nodes()) {
    positions.push_back(node.position);
    radii.push_back(node.radius);
  }
  std::vector<std::uint32_t> ends;
  for (const CenterlineSegment& segment : centerline.segments()) ends.insert(ends.end(), {segment.a, segment.b});
  json["node_positions"] = raw(positions);
  json["radii"] = raw(radii);
  json["ends"] = raw(ends);
}

void add_surface(const LivePage& page, Json& json) {
  std::vector<std::uint32_t> corners, segments;
  for (const auto& face : page.mesh.faces) corners.insert(corners.end(), face.begin(), face.end());
  std::vector<double> parameters;
  for (const SurfacePlace& place : page.places) {
    segments.push_back(place.segment);
    parameters.push_back(place.t);
  }
  json["positions"] = raw(page.mesh.vertices);
  json["normals"] = raw(page.normals);
  json["corners"] = raw(corners);
  json["place_segments"] = raw(segments);
  json["place_parameters"] = raw(parameters);
}

Json to_json(const LivePage& page) {
  const std::string tree = page.tree.filename().string(), surface = page.surface.filename().string();
  const char* const command[] = {"vmesh",    "deform",     tree.c_str(), surface.c_str(),
                                 "--script", "scene.json", "-o",         "frames/"};
  Json json = {{"title", surface},
               {"generator", generator_name()},
               {"command", quoted_command(static_cast<int>(std::size(command)), command)},
               {"facts",
                {{"Segments", page.centerline.segments().size()},
                 {"Vertices", page.mesh.vertices.size()},
                 {"Triangles", page.mesh.faces.size()},
                 {"Held from the start", page.fix.size() + page.clamp.size()}}},
               {"settings", settings_of(page)}};
  add_tree(page.centerline, json);
  add_surface(page, json);
  return json;
}

}  // namespace

std::string to_html(const LivePage& page) {
  const LiveParts& parts = live_parts();
  const Json json = to_json(page);
  const std::string data = script_safe(json.dump(-1, ' ', false, Json::error_handler_t::replace));
  const std::string title = html_escaped(page.surface.filename().string() + " \u2013 vmesh deform");
  return filled(parts.page, {{"@TITLE@", title},
                             {"@STYLE@", parts.style},
                             {"@DATA@", data},
                             {"@LICENSE@", parts.license},
                             {"@FIRST@", parts.first},
                             {"@THREE@", parts.three},
                             {"@DEFORMER@", parts.deformer},
                             {"@SCRIPT@", parts.script}});
}

}  // namespace vmesh::tool

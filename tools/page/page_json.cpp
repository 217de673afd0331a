#include "page/page_json.h"

#include <algorithm>
#include <cmath>

#include "page/packing.h"

namespace vmesh::tool {
namespace {

using tool::to_json;

/// Names of attributes on a page. Others keep theirs.
struct Naming {
  const char *name, *label, *unit;
};
constexpr Naming kNamings[] = {{"EquiangleSkewness", "Skewness", ""},
                               {"distance", "Distance to the reference", "mm"},
                               {"volume_distance", "Distance to the vessels", "mm"},
                               {"relative_distance", "Distance to the vessels", "radii"},
                               {"displacement", "Displacement", "mm"},
                               {"radius", "Vessel radius", "mm"},
                               {"MaximumInscribedSphereRadius", "Vessel radius", "mm"},
                               {"branch", "Branch", ""},
                               {"segment", "Segment", ""},
                               {"parameter", "Place on its segment", ""},
                               {"opening", "Opening", ""},
                               {"ModelFaceID", "Face of the model", ""},
                               {"CapID", "Cap", ""}};
/// Colours in a file are derived from other attributes.
constexpr const char* kHidden[] = {"red", "green", "blue", "alpha", "quality", "nx", "ny", "nz"};

std::vector<std::int64_t> corners(const TriMesh& mesh) {
  std::vector<std::int64_t> all;
  all.reserve(3 * mesh.faces.size());
  for (const Triangle& face : mesh.faces) all.insert(all.end(), face.begin(), face.end());
  return all;
}

/// Ordered so that the numbers of a face are close to each other and to those of the previous face.
std::string pack_corners(const TriMesh& mesh) {
  std::vector<std::int64_t> numbers = corners(mesh);
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    numbers[i + 2] -= numbers[i + 1];
    numbers[i + 1] -= numbers[i];
  }
  return pack(numbers, 3);
}

Json to_json(const MeshAttribute& attribute, const char* on) {
  const auto known = std::find_if(std::begin(kNamings), std::end(kNamings),
                                  [&](const Naming& naming) { return attribute.name == naming.name; });
  const bool found = known != std::end(kNamings);
  const ValueGrid grid = grid_over(attribute.values, attribute.integer);
  return {{"name", attribute.name},
          {"label", found ? known->label : attribute.name},
          {"unit", found ? known->unit : ""},
          {"on", on},
          {"labels", attribute.integer},
          {"low", grid.low},
          {"step", grid.step},
          {"values", pack(on_grid(attribute.values, grid))}};
}

bool is_hidden(const MeshAttribute& attribute) {
  return std::find(std::begin(kHidden), std::end(kHidden), attribute.name) != std::end(kHidden);
}

/// All attributes in one list. An attribute of vertices replaces the same one of faces, except for labels, whose
/// borders follow faces.
Json attributes_json(const MeshAttributes& attributes) {
  Json list = Json::array();
  for (const MeshAttribute& a : attributes.vertex) {
    if (!is_hidden(a)) list.push_back(to_json(a, "vertex"));
  }
  for (const MeshAttribute& a : attributes.face) {
    const bool twice = std::any_of(attributes.vertex.begin(), attributes.vertex.end(),
                                   [&](const MeshAttribute& other) { return other.name == a.name; });
    if (!is_hidden(a) && !twice) list.push_back(to_json(a, "face"));
  }
  return list;
}

Json to_json(const PageSurface& surface) {
  const PointGrid grid = grid_over(surface.mesh.vertices);
  return {{"name", surface.name},
          {"reference", surface.reference},
          {"vertices", surface.mesh.vertices.size()},
          {"faces", surface.mesh.faces.size()},
          {"low", to_json(grid.low)},
          {"step", grid.step},
          {"positions", pack(on_grid(surface.mesh.vertices, grid), 3)},
          {"corners", pack_corners(surface.mesh)},
          {"attributes", attributes_json(surface.attributes)}};
}

Json lines_json(const Centerline& centerline) {
  std::vector<Vec3> positions;
  std::vector<double> radius;
  for (const CenterlineNode& node : centerline.nodes()) {
    positions.push_back(node.position);
    radius.push_back(node.radius);
  }
  std::vector<std::int64_t> ends;
  for (const CenterlineSegment& segment : centerline.segments()) {
    ends.push_back(segment.a);
    ends.push_back(segment.b);
  }
  const PointGrid grid = grid_over(positions);
  const ValueGrid radii = grid_over(radius, false);
  return {{"nodes", positions.size()},
          {"segments", centerline.segments().size()},
          {"low", to_json(grid.low)},
          {"step", grid.step},
          {"positions", pack(on_grid(positions, grid), 3)},
          {"ends", pack(ends, 2)},
          {"radius", {{"low", radii.low}, {"step", radii.step}, {"values", pack(on_grid(radius, radii))}}}};
}

Json to_json(const PagePlace& place) {
  return {{"label", place.label},
          {"value", place.value},
          {"at", to_json(place.position)},
          {"attribute", place.attribute},
          {"surface", place.surface}};
}

Json to_json(const PageHistogram& h) {
  return {{"title", h.title},
          {"unit", h.unit},
          {"low", h.histogram.low},
          {"high", h.histogram.high},
          {"counts", h.histogram.counts},
          {"mean", h.distribution.mean},
          {"p95", h.distribution.p95},
          {"min", h.distribution.min},
          {"max", h.distribution.max}};
}

Json to_json(const ReportTable& table) {
  return {{"title", table.title}, {"columns", table.columns}, {"rows", table.rows}};
}

Json to_json(const PageFrames& frames) {
  return {{"every", frames.every()}, {"time_s", frames.time_s()}, {"moves", frames.packed()}};
}

template <class List>
Json all_json(const List& list) {
  return list_json(list, [](const auto& element) { return to_json(element); });
}

using Pair = std::pair<std::string, std::string>;

Json fact_json(const Pair& fact) { return Json::array({fact.first, fact.second}); }

Json picture_json(const Pair& picture) {
  const auto& [caption, svg] = picture;
  const std::vector<unsigned char> bytes(svg.begin(), svg.end());
  return Json::array({caption, "data:image/svg+xml;base64," + base64(bytes)});
}

/// `text` as valid UTF-8.
std::string repaired(const std::string& text) {
  using nlohmann::json;
  return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

}  // namespace

Json to_json(const Page& page) {
  return {{"schema", "vmesh.page/1"},
          {"generator", generator_json()},
          {"title", repaired(page.title)},
          {"verb", page.verb},
          {"command_line", page.command_line},
          {"options", page.options},
          {"facts", list_json(page.facts, fact_json)},
          {"warnings", page.warnings},
          {"surfaces", all_json(page.surfaces)},
          {"centerline", page.centerline ? lines_json(*page.centerline) : Json()},
          {"places", all_json(page.places)},
          {"histograms", all_json(page.histograms)},
          {"tables", all_json(page.tables)},
          {"pictures", list_json(page.pictures, picture_json)},
          {"frames", page.frames ? to_json(*page.frames) : Json()}};
}

}  // namespace vmesh::tool

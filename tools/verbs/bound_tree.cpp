#include "verbs/bound_tree.h"

#include <optional>
#include <utility>

namespace vmesh::tool {
namespace {

bool is_place(const Centerline& centerline, double segment, double t, const Vec3& vertex) {
  if (!(segment >= 0 && segment < static_cast<double>(centerline.segments().size()) && t >= 0 && t <= 1)) return false;
  const Index s = static_cast<Index>(segment);
  return (vertex - centerline.point_at(s, t)).norm() <= kFarthestPlace * centerline.radius_at(s, t);
}

/// The places on the centerline stored in the surface's file, if they belong to this centerline.
std::optional<std::vector<SurfacePlace>> places_in_file(const Centerline& centerline, const LoadedSurface& surface) {
  const MeshAttribute* segment = find_attribute(surface.attributes.vertex, "segment");
  const MeshAttribute* t = find_attribute(surface.attributes.vertex, "parameter");
  if (!segment || !t) return std::nullopt;
  std::vector<SurfacePlace> places;
  for (std::size_t v = 0; v < surface.mesh.vertices.size(); ++v) {
    if (!is_place(centerline, segment->values[v], t->values[v], surface.mesh.vertices[v])) return std::nullopt;
    places.push_back({static_cast<Index>(segment->values[v]), t->values[v]});
  }
  return places;
}

std::vector<SurfacePlace> places_of(const Centerline& centerline, const LoadedSurface& surface, Console& console) {
  if (auto places = places_in_file(centerline, surface)) return *places;
  console.log("the surface's file has no places on this centerline; every vertex is bound to the nearest segment");
  return nearest_places(centerline, surface.mesh.vertices);
}

}  // namespace

BoundTree bound_tree(const Centerline& centerline, LoadedSurface surface, Console& console) {
  std::vector<CenterlineBinding> binding;
  for (const auto& [segment, t] : places_of(centerline, surface, console)) binding.push_back({segment, t});
  return {centerline, std::move(surface.mesh), std::move(surface.attributes), std::move(binding)};
}

std::vector<SurfacePlace> places_on(const std::vector<CenterlineBinding>& binding) {
  std::vector<SurfacePlace> places;
  for (const CenterlineBinding& b : binding) places.push_back({b.segment, b.t});
  return places;
}

}  // namespace vmesh::tool

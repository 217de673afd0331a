#include "binding.h"

#include <algorithm>

namespace vmesh::python {
namespace {

/// A vertex farther from its place than this many local radii must be bound to another centerline.
constexpr double kFarthestPlace = 4;

const std::vector<double>* find(const std::vector<MeshAttribute>& attributes, const std::string& name) {
  const auto found = std::find_if(attributes.begin(), attributes.end(), [&](const auto& a) { return a.name == name; });
  return found == attributes.end() ? nullptr : &found->values;
}

bool is_place(const Centerline& centerline, double segment, double t, const Vec3& vertex) {
  if (!(segment >= 0 && segment < static_cast<double>(centerline.segments().size()) && t >= 0 && t <= 1)) return false;
  const auto s = static_cast<Index>(segment);
  return (vertex - centerline.point_at(s, t)).norm() <= kFarthestPlace * centerline.radius_at(s, t);
}

std::optional<std::vector<CenterlineBinding>> places_in_file(const SurfaceObject& surface,
                                                             const Centerline& centerline) {
  const std::vector<double>* segment = find(surface.attributes.vertex, "segment");
  const std::vector<double>* t = find(surface.attributes.vertex, "parameter");
  if (segment == nullptr || t == nullptr) return std::nullopt;
  std::vector<CenterlineBinding> binding;
  for (std::size_t v = 0; v < surface.mesh().vertices.size(); ++v) {
    if (!is_place(centerline, (*segment)[v], (*t)[v], surface.mesh().vertices[v])) return std::nullopt;
    binding.push_back({static_cast<Index>((*segment)[v]), (*t)[v]});
  }
  return binding;
}

std::vector<CenterlineBinding> nearest(const SurfaceObject& surface, const Centerline& centerline) {
  std::vector<CenterlineBinding> binding;
  for (const auto& [segment, t] : nearest_places(centerline, surface.mesh().vertices)) binding.push_back({segment, t});
  return binding;
}

std::vector<double> radii_at(const std::vector<CenterlineBinding>& binding, const Centerline& centerline) {
  std::vector<double> isolated;
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    if (centerline.degree(n) == 0) isolated.push_back(centerline.node(n).radius);
  }
  std::vector<double> radius;
  const std::size_t segments = centerline.segments().size();
  for (const auto& [segment, t] : binding)
    radius.push_back(segment < segments ? centerline.radius_at(segment, t) : isolated[segment - segments]);
  return radius;
}

}  // namespace

void bind_to(SurfaceObject& surface, const CenterlinePtr& centerline) {
  const Centerline& c = centerline->centerline;
  const auto in_file = places_in_file(surface, c);
  surface.result.binding = in_file ? *in_file : nearest(surface, c);
  surface.result.radius = radii_at(surface.result.binding, c);
  surface.centerline = centerline;
}

std::vector<SurfacePlace> places_of(const SurfaceObject& surface) {
  std::vector<SurfacePlace> places;
  for (const auto& [segment, t] : surface.result.binding) places.push_back({segment, t});
  return places;
}

}  // namespace vmesh::python

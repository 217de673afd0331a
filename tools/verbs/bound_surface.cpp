#include "verbs/bound_surface.h"

#include <algorithm>
#include <string>

#include "vmesh/core/error.h"
#include "vmesh/mesh/find_attribute.h"

namespace vmesh::tool {

std::vector<CenterlineBinding> binding_of(const LoadedSurface& surface, const Centerline& centerline) {
  const MeshAttribute* segment = find_attribute(surface.attributes.vertex, "segment");
  const MeshAttribute* t = find_attribute(surface.attributes.vertex, "parameter");
  if (!segment || !t)
    throw InvalidInput(
        "the surface has no places on a centerline (vertex attributes segment and parameter); take one "
        "that vmesh generate wrote as .ply or .vtp");
  std::vector<CenterlineBinding> binding;
  for (std::size_t v = 0; v < surface.mesh.vertices.size(); ++v) {
    const double s = segment->values[v];
    if (!(s >= 0 && s < static_cast<double>(centerline.segments().size() + centerline.nodes().size())))
      throw InvalidInput("vertex " + std::to_string(v) +
                         " is bound to a segment that the centerline does not have; is "
                         "it the one around which the surface was grown?");
    binding.push_back({static_cast<Index>(s), std::clamp(t->values[v], 0.0, 1.0)});
  }
  return binding;
}

}  // namespace vmesh::tool

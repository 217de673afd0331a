#include "vmesh/surface/followed_surface.h"

#include <string>

#include "vmesh/core/error.h"
#include "vmesh/volume/cone_relations.h"

namespace vmesh {

std::vector<Vec3> follow_edit(const std::vector<Vec3>& vertices, const std::vector<CenterlineBinding>& binding,
                              const Centerline& centerline, const CenterlineEdit& edit) {
  if (!edit.removed_branches.empty())
    throw InvalidInput("a surface cannot follow when branches are removed; grow one around the edited centerline");
  if (binding.size() != vertices.size())
    throw InvalidInput("the surface has " + std::to_string(vertices.size()) + " vertices, but " +
                       std::to_string(binding.size()) + " are bound to the centerline");
  const ConeRelations relations(centerline);
  const ChangedRadius radius(centerline, edit.radius);
  std::vector<Vec3> moved;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto& [segment, t] = binding[v];
    if (segment >= relations.cone_count())
      throw InvalidInput("vertex " + std::to_string(v) + " is bound to segment " + std::to_string(segment) +
                         ", which the centerline does not have");
    const Vec3 axis = relations.axis_point(segment, t);
    moved.push_back(edit.scale * (axis + radius.factor(segment, t) * (vertices[v] - axis)));
  }
  return moved;
}

}  // namespace vmesh

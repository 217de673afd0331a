#include "vmesh/solid/vessel_wall.h"

#include <algorithm>
#include <cmath>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/mesh/find_attribute.h"

namespace vmesh {
namespace {

std::vector<double> radii_of(const TriMesh& mesh, const MeshAttributes& attributes) {
  const MeshAttribute* radius = find_attribute(attributes.vertex, "radius");
  if (!radius)
    throw InvalidInput(
        "the surface has no radius at its vertices, by which layers and cells are sized; make it with vmesh generate, "
        "as .vtp or .ply");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double r = radius->values[v];
    if (!(r > 0 && std::isfinite(r))) throw InvalidInput(formatted("vertex %zu: radius %g; it must be positive", v, r));
  }
  return radius->values;
}

Index face_number(double value, std::size_t f) {
  constexpr double kMost = 1e9;
  if (!(value >= 1 && value <= kMost && value == std::floor(value)))
    throw InvalidInput(formatted("face %zu: ModelFaceID %g; 1 is the wall, and caps are numbered from 2 on", f, value));
  return static_cast<Index>(value);
}

}  // namespace

VesselWall vessel_wall(TriMesh mesh, const MeshAttributes& attributes) {
  VesselWall wall;
  wall.radius = radii_of(mesh, attributes);
  wall.patch.assign(mesh.faces.size(), 0);
  const std::vector<std::string>& names = attributes.patch_names;
  wall.patch_names = {names.empty() ? "wall" : names[0]};
  if (const MeshAttribute* label = find_attribute(attributes.face, "ModelFaceID")) {
    std::vector<Index> number;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) number.push_back(face_number(label->values[f], f));
    std::vector<Index> caps = number;
    std::sort(caps.begin(), caps.end());
    caps.erase(std::unique(caps.begin(), caps.end()), caps.end());
    std::erase(caps, 1);
    for (const Index cap : caps) {
      wall.patch_names.push_back(cap <= names.size() ? names[cap - 1] : "cap_" + std::to_string(cap - 1));
    }
    for (std::size_t f = 0; f < number.size(); ++f) {
      if (number[f] == 1) continue;
      wall.patch[f] = static_cast<Index>(std::lower_bound(caps.begin(), caps.end(), number[f]) - caps.begin()) + 1;
    }
  }
  wall.mesh = std::move(mesh);
  return wall;
}

}  // namespace vmesh

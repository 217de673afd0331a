#include "vmesh/solid/vessel_wall.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/patch_names.h"

namespace vmesh {
namespace {

constexpr const char* kNoWall = "the surface has no faces of the wall, only caps";

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

std::vector<Index> face_numbers(std::size_t faces, const MeshAttributes& attributes) {
  const MeshAttribute* label = find_attribute(attributes.face, "ModelFaceID");
  if (label == nullptr) return std::vector<Index>(faces, 1);
  std::vector<Index> numbers;
  for (std::size_t f = 0; f < faces; ++f) numbers.push_back(face_number(label->values[f], f));
  return numbers;
}

/// Those that have faces, in ascending order but for that.
std::vector<Index> patches_walls_first(std::vector<Index> numbers, const std::vector<std::string>& names) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  const auto is_wall = [&](Index number) { return is_wall_patch(number, names); };
  if (std::none_of(numbers.begin(), numbers.end(), is_wall)) throw InvalidInput(kNoWall);
  std::stable_partition(numbers.begin(), numbers.end(), is_wall);
  return numbers;
}

std::string name_of(Index patch, const std::vector<std::string>& names) {
  if (patch <= names.size()) return names[patch - 1];
  return patch == 1 ? "wall" : "cap_" + std::to_string(patch - 1);
}

}  // namespace

VesselWall vessel_wall(TriMesh mesh, const MeshAttributes& attributes) {
  VesselWall wall;
  wall.radius = radii_of(mesh, attributes);
  const std::vector<Index> number = face_numbers(mesh.faces.size(), attributes);
  const std::vector<Index> patches = patches_walls_first(number, attributes.patch_names);
  wall.wall_patches = static_cast<Index>(std::count_if(
      patches.begin(), patches.end(), [&](Index patch) { return is_wall_patch(patch, attributes.patch_names); }));
  std::map<Index, Index> rank;
  for (const Index patch : patches) {
    rank[patch] = static_cast<Index>(wall.patch_names.size());
    wall.patch_names.push_back(name_of(patch, attributes.patch_names));
  }
  for (const Index patch : number) wall.patch.push_back(rank.at(patch));
  wall.mesh = std::move(mesh);
  return wall;
}

}  // namespace vmesh

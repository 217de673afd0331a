#include "vmesh/mesh/split_wedges.h"

#include <algorithm>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"

namespace vmesh {
namespace {

/// The wedge turned so that its corner with the lowest number is the first.
Wedge lowest_first(const Wedge& wedge) {
  static constexpr std::array<std::array<std::size_t, 6>, 6> kTurns = {{{0, 1, 2, 3, 4, 5},
                                                                        {1, 2, 0, 4, 5, 3},
                                                                        {2, 0, 1, 5, 3, 4},
                                                                        {3, 5, 4, 0, 2, 1},
                                                                        {4, 3, 5, 1, 0, 2},
                                                                        {5, 4, 3, 2, 1, 0}}};
  const auto lowest = static_cast<std::size_t>(std::min_element(wedge.begin(), wedge.end()) - wedge.begin());
  Wedge turned;
  for (std::size_t i = 0; i < 6; ++i) turned[i] = wedge[kTurns[lowest][i]];
  return turned;
}

/// Both quads at corner a are cut through it; so only the third one is left to decide on.
std::array<Tetrahedron, 3> split(const Wedge& wedge) {
  const auto [a, b, c, d, e, f] = lowest_first(wedge);
  if (std::min(b, f) < std::min(c, e)) return {{{a, b, c, f}, {a, b, f, e}, {a, e, f, d}}};
  return {{{a, b, c, e}, {a, e, c, f}, {a, e, f, d}}};
}

std::array<BoundaryFace, 2> split(const BoundaryFace& quad) {
  const auto& [a, b, c, d] = quad.corners;
  if (std::min(a, c) < std::min(b, d)) return {{{{a, b, c, kNone}, quad.patch}, {{a, c, d, kNone}, quad.patch}}};
  return {{{{a, b, d, kNone}, quad.patch}, {{b, c, d, kNone}, quad.patch}}};
}

void check_split(const VolumeMesh& mesh, std::size_t wedge, const Tetrahedron& cell) {
  const Vec3& a = mesh.points[cell[0]];
  const Vec3 &b = mesh.points[cell[1]], &c = mesh.points[cell[2]], &d = mesh.points[cell[3]];
  if ((b - a).cross(c - a).dot(d - a) > 0) return;
  throw InvalidInput(formatted("wedge %zu, at (%.4g, %.4g, %.4g) mm, cannot be split into tetrahedra: it is too skewed",
                               wedge, a.x(), a.y(), a.z()));
}

}  // namespace

SplitWedges split_wedges(const VolumeMesh& mesh) {
  SplitWedges result;
  VolumeMesh& split_mesh = result.mesh;
  split_mesh.points = mesh.points;
  split_mesh.region_names = mesh.region_names;
  split_mesh.patch_names = mesh.patch_names;
  split_mesh.tetrahedra = mesh.tetrahedra;
  split_mesh.tetrahedra.reserve(mesh.tetrahedra.size() + 3 * mesh.wedges.size());
  for (Index cell = 0; cell < mesh.tetrahedra.size(); ++cell) result.cell_origins.push_back(cell);
  for (std::size_t w = 0; w < mesh.wedges.size(); ++w) {
    for (const Tetrahedron& cell : split(mesh.wedges[w])) {
      check_split(mesh, w, cell);
      split_mesh.tetrahedra.push_back(cell);
      result.cell_origins.push_back(static_cast<Index>(mesh.tetrahedra.size() + w));
    }
  }
  for (const Index origin : result.cell_origins) split_mesh.cell_region.push_back(mesh.cell_region[origin]);
  for (const BoundaryFace& face : mesh.boundary) {
    if (face.is_triangle()) {
      split_mesh.boundary.push_back(face);
    } else {
      for (const BoundaryFace& half : split(face)) split_mesh.boundary.push_back(half);
    }
  }
  return result;
}

VolumeAttributes split_attributes(const VolumeAttributes& attributes, const std::vector<Index>& cell_origins) {
  VolumeAttributes result{attributes.point, {}};
  for (const MeshAttribute& before : attributes.cell) {
    MeshAttribute after{before.name, {}, before.integer};
    after.values.reserve(cell_origins.size());
    for (const Index origin : cell_origins) after.values.push_back(before.values[origin]);
    result.cell.push_back(std::move(after));
  }
  return result;
}

}  // namespace vmesh

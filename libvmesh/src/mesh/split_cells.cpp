#include "vmesh/mesh/split_cells.h"

#include <algorithm>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/mesh/volume_faces.h"

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

std::array<Tetrahedron, 2> split(const Pyramid& pyramid) {
  const auto& [a, b, c, d, e] = pyramid;
  if (std::min(a, c) < std::min(b, d)) return {{{a, b, c, e}, {a, c, d, e}}};
  return {{{a, b, d, e}, {b, c, d, e}}};
}

std::array<Tetrahedron, 1> split(const Tetrahedron& cell) { return {cell}; }

std::array<BoundaryFace, 2> split(const BoundaryFace& quad) {
  const auto& [a, b, c, d] = quad.corners;
  if (std::min(a, c) < std::min(b, d)) return {{{{a, b, c, kNone}, quad.patch}, {{a, c, d, kNone}, quad.patch}}};
  return {{{{a, b, d, kNone}, quad.patch}, {{b, c, d, kNone}, quad.patch}}};
}

bool has_volume(const std::vector<Vec3>& points, const Tetrahedron& cell) {
  const Vec3& a = points[cell[0]];
  return (points[cell[1]] - a).cross(points[cell[2]] - a).dot(points[cell[3]] - a) > 0;
}

[[noreturn]] void refuse_skewed(const VolumeMesh& mesh, Index cell, Index corner) {
  const Vec3& at = mesh.points[corner];
  throw InvalidInput(formatted("cell %u, at (%.4g, %.4g, %.4g) mm, cannot be split into tetrahedra: it is too skewed",
                               cell, at.x(), at.y(), at.z()));
}

}  // namespace

SplitCells split_cells(const VolumeMesh& mesh) {
  SplitCells result;
  VolumeMesh& split_mesh = result.mesh;
  split_mesh.points = mesh.points;
  split_mesh.region_names = mesh.region_names;
  split_mesh.patch_names = mesh.patch_names;
  split_mesh.tetrahedra.reserve(mesh.tetrahedra.size() + 3 * mesh.wedges.size() + 2 * mesh.pyramids.size());
  Index origin = 0;
  for_each_cell(mesh, [&](const auto& cell) {
    for (const Tetrahedron& part : split(cell)) {
      if (cell.size() > 4 && !has_volume(mesh.points, part)) refuse_skewed(mesh, origin, cell[0]);
      split_mesh.tetrahedra.push_back(part);
      result.cell_origins.push_back(origin);
    }
    ++origin;
  });
  for (const Index cell : result.cell_origins) split_mesh.cell_region.push_back(mesh.cell_region[cell]);
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

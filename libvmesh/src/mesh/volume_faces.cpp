#include "vmesh/mesh/volume_faces.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "vmesh/core/error.h"
#include "vmesh/mesh/patch_names.h"

namespace vmesh {
namespace {

/// The same for a face seen from either side.
CellFace key_of(CellFace face) {
  std::sort(face.begin(), face.end());
  return face;
}

struct FaceHash {
  std::size_t operator()(const CellFace& face) const {
    std::uint64_t hash = 0;
    for (const Index v : face) {
      hash = (hash ^ v) * 0xff51afd7ed558ccdULL;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

/// Whether the corners of two faces of the same points follow each other in the same sense.
bool same_side(const CellFace& a, const CellFace& b) {
  const std::size_t count = a[3] == kNone ? 3 : 4;
  const auto at = static_cast<std::size_t>(std::find(b.begin(), b.begin() + count, a[0]) - b.begin());
  return b[(at + 1) % count] == a[1];
}

std::string name_of(std::size_t face) { return "face " + std::to_string(face) + " of the volume's boundary "; }

/// Calls `take` with every side of every cell and the corners of that face.
template <class Take>
void for_each_side(const VolumeMesh& mesh, const Take& take) {
  Index cell = 0;
  for_each_cell(mesh, [&](const auto& corners) {
    const auto faces = faces_of(corners);
    for (Index f = 0; f < faces.size(); ++f) take(CellSide{cell, f}, faces[f]);
    ++cell;
  });
}

template <class Cell>
void check_corners(const std::vector<Cell>& cells, std::size_t points, const char* word) {
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (const Index v : cells[c]) {
      if (v >= points)
        throw InvalidInput(std::string(word) + " " + std::to_string(c) + " names point " + std::to_string(v) +
                           ", but the mesh has " + std::to_string(points) + " points");
    }
  }
}

void check_boundary(const VolumeMesh& mesh) {
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
    const BoundaryFace& face = mesh.boundary[f];
    for (std::size_t i = 0; i < (face.is_triangle() ? 3u : 4u); ++i) {
      if (face.corners[i] >= mesh.points.size())
        throw InvalidInput(name_of(f) + "names point " + std::to_string(face.corners[i]) + ", but the mesh has " +
                           std::to_string(mesh.points.size()) + " points");
    }
    if (face.patch >= mesh.patch_names.size())
      throw InvalidInput(name_of(f) + "is of patch " + std::to_string(face.patch) + ", but there are names for " +
                         std::to_string(mesh.patch_names.size()));
  }
}

struct KeyedSide {
  CellFace key, corners;
  Index cell;
};

/// The sides of all cells that are not in the boundary.
std::vector<KeyedSide> sides_inside(const VolumeMesh& mesh) {
  std::unordered_set<CellFace, FaceHash> outside;
  outside.reserve(mesh.boundary.size());
  for (const BoundaryFace& face : mesh.boundary) outside.insert(key_of(face.corners));
  std::vector<KeyedSide> sides;
  sides.reserve(4 * mesh.tetrahedra.size() + 5 * (mesh.wedges.size() + mesh.pyramids.size()));
  for_each_side(mesh, [&](const CellSide& side, const CellFace& face) {
    const CellFace key = key_of(face);
    if (!outside.contains(key)) sides.push_back({key, face, side.cell});
  });
  return sides;
}

[[noreturn]] void fail_conformity(const KeyedSide& side, const char* what) {
  std::string corners;
  for (const Index v : side.corners) {
    if (v != kNone) corners += (corners.empty() ? "" : ", ") + std::to_string(v);
  }
  throw InvalidInput("cells do not meet face to face: the face of cell " + std::to_string(side.cell) + " with points " +
                     corners + " " + what);
}

}  // namespace

std::array<CellFace, 4> faces_of(const Tetrahedron& cell) {
  const auto& [a, b, c, d] = cell;
  return {{{a, c, b, kNone}, {a, b, d, kNone}, {b, c, d, kNone}, {c, a, d, kNone}}};
}

std::array<CellFace, 5> faces_of(const Wedge& cell) {
  const auto& [a, b, c, d, e, f] = cell;
  return {{{a, c, b, kNone}, {d, e, f, kNone}, {a, b, e, d}, {b, c, f, e}, {c, a, d, f}}};
}

std::array<CellFace, 5> faces_of(const Pyramid& cell) {
  const auto& [a, b, c, d, e] = cell;
  return {{{a, d, c, b}, {a, b, e, kNone}, {b, c, e, kNone}, {c, d, e, kNone}, {d, a, e, kNone}}};
}

std::vector<CellSide> sides_of_boundary(const VolumeMesh& mesh) {
  std::unordered_map<CellFace, Index, FaceHash> number;
  number.reserve(mesh.boundary.size());
  for (Index f = 0; f < mesh.boundary.size(); ++f) {
    if (!number.try_emplace(key_of(mesh.boundary[f].corners), f).second)
      throw InvalidInput(name_of(f) + "is there twice");
  }
  std::vector<bool> outside(mesh.points.size(), false);
  for (const BoundaryFace& face : mesh.boundary) {
    for (std::size_t i = 0; i < (face.is_triangle() ? 3u : 4u); ++i) outside[face.corners[i]] = true;
  }
  std::vector<CellSide> sides(mesh.boundary.size());
  std::vector<bool> turned(mesh.boundary.size(), false);
  for_each_side(mesh, [&](const CellSide& side, const CellFace& face) {
    // Most faces are inside, and most of these have a corner that is.
    if (!outside[face[0]] || !outside[face[1]] || !outside[face[2]]) return;
    const auto found = number.find(key_of(face));
    if (found == number.end()) return;
    const Index f = found->second;
    if (sides[f].cell != kNone) throw InvalidInput(name_of(f) + "lies between two cells");
    sides[f] = side;
    turned[f] = !same_side(face, mesh.boundary[f].corners);
  });
  for (std::size_t f = 0; f < sides.size(); ++f) {
    if (sides[f].cell == kNone) throw InvalidInput(name_of(f) + "is no face of a cell");
    if (turned[f]) throw InvalidInput(name_of(f) + "is turned inwards");
  }
  return sides;
}

BoundarySurface boundary_surface(const VolumeMesh& mesh) {
  BoundarySurface surface;
  std::vector<Index> number(mesh.points.size(), kNone);
  for (const BoundaryFace& face : mesh.boundary) {
    for (const Index v : face.corners) {
      if (v != kNone) number[v] = 0;
    }
  }
  for (Index v = 0; v < number.size(); ++v) {
    if (number[v] == kNone) continue;
    number[v] = static_cast<Index>(surface.mesh.vertices.size());
    surface.mesh.vertices.push_back(mesh.points[v]);
  }
  const auto add = [&](Index a, Index b, Index c, Index patch) {
    surface.mesh.faces.push_back({number[a], number[b], number[c]});
    surface.patch.push_back(patch);
  };
  for (const auto& [corners, patch] : mesh.boundary) {
    const auto& [a, b, c, d] = corners;
    add(a, b, c, patch);
    if (d != kNone) add(a, c, d, patch);
  }
  return surface;
}

std::vector<CellFace> outer_faces(const VolumeMesh& mesh) {
  std::unordered_map<CellFace, int, FaceHash> count;
  for_each_side(mesh, [&](const CellSide&, const CellFace& face) { ++count[key_of(face)]; });
  std::vector<CellFace> faces;
  for_each_side(mesh, [&](const CellSide&, const CellFace& face) {
    if (count.at(key_of(face)) == 1) faces.push_back(face);
  });
  return faces;
}

std::vector<InnerFace> inner_faces(const VolumeMesh& mesh) {
  std::vector<KeyedSide> keyed = sides_inside(mesh);
  std::sort(keyed.begin(), keyed.end(),
            [](const KeyedSide& a, const KeyedSide& b) { return std::tie(a.key, a.cell) < std::tie(b.key, b.cell); });
  std::vector<InnerFace> faces;
  faces.reserve(keyed.size() / 2);
  for (std::size_t i = 0; i < keyed.size(); i += 2) {
    const KeyedSide& first = keyed[i];
    if (i + 1 == keyed.size() || keyed[i + 1].key != first.key)
      fail_conformity(first, "belongs to no other cell and is not in the boundary");
    if (i + 2 < keyed.size() && keyed[i + 2].key == first.key) fail_conformity(first, "belongs to more than two cells");
    const KeyedSide& second = keyed[i + 1];
    if (same_side(first.corners, second.corners)) fail_conformity(first, "has its two cells on the same side");
    faces.push_back({first.corners, first.cell, second.cell});
  }
  std::sort(faces.begin(), faces.end(), [](const InnerFace& a, const InnerFace& b) {
    return std::tie(a.owner, a.neighbour) < std::tie(b.owner, b.neighbour);
  });
  return faces;
}

void check_volume_mesh(const VolumeMesh& mesh) {
  check_corners(mesh.tetrahedra, mesh.points.size(), "tetrahedron");
  check_corners(mesh.wedges, mesh.points.size(), "wedge");
  check_corners(mesh.pyramids, mesh.points.size(), "pyramid");
  check_patch_names(mesh.region_names, "region", "regions");
  check_patch_names(mesh.patch_names, "patch", "patches");
  check_boundary(mesh);
  if (mesh.cell_region.size() != mesh.cell_count())
    throw InvalidInput("the volume mesh has " + std::to_string(mesh.cell_count()) + " cells, but regions for " +
                       std::to_string(mesh.cell_region.size()));
  for (std::size_t c = 0; c < mesh.cell_region.size(); ++c) {
    if (mesh.cell_region[c] >= mesh.region_names.size())
      throw InvalidInput("cell " + std::to_string(c) + " is of region " + std::to_string(mesh.cell_region[c]) +
                         ", but there are names for " + std::to_string(mesh.region_names.size()));
  }
}

}  // namespace vmesh

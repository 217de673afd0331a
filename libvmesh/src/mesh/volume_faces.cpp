#include "vmesh/mesh/volume_faces.h"

#include <algorithm>
#include <set>
#include <string>
#include <unordered_map>

#include "vmesh/core/error.h"

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

/// Calls `take` with the number of every cell and each of its faces.
template <class Take>
void for_each_face(const VolumeMesh& mesh, const Take& take) {
  Index cell = 0;
  for_each_cell(mesh, [&](const auto& corners) {
    for (const CellFace& face : faces_of(corners)) take(cell, face);
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

void check_names(const std::vector<std::string>& names, const char* word, const char* words) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (name.empty()) throw InvalidInput(std::string("a ") + word + " of the volume mesh has no name");
    if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < ' '; }))
      throw InvalidInput(std::string("the name of a ") + word + " has to be on one line: \"" + name + "\"");
    if (!seen.insert(name).second) throw InvalidInput(std::string("two ") + words + " have the name \"" + name + "\"");
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

std::vector<Index> cells_behind_boundary(const VolumeMesh& mesh) {
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
  std::vector<Index> behind(mesh.boundary.size(), kNone);
  std::vector<bool> turned(mesh.boundary.size(), false);
  for_each_face(mesh, [&](Index cell, const CellFace& face) {
    // Most faces are inside, and most of these have a corner that is.
    if (!outside[face[0]] || !outside[face[1]] || !outside[face[2]]) return;
    const auto found = number.find(key_of(face));
    if (found == number.end()) return;
    if (behind[found->second] != kNone) throw InvalidInput(name_of(found->second) + "lies between two cells");
    behind[found->second] = cell;
    turned[found->second] = !same_side(face, mesh.boundary[found->second].corners);
  });
  for (std::size_t f = 0; f < behind.size(); ++f) {
    if (behind[f] == kNone) throw InvalidInput(name_of(f) + "is no face of a cell");
    if (turned[f]) throw InvalidInput(name_of(f) + "is turned inwards");
  }
  return behind;
}

void check_volume_mesh(const VolumeMesh& mesh) {
  check_corners(mesh.tetrahedra, mesh.points.size(), "tetrahedron");
  check_corners(mesh.wedges, mesh.points.size(), "wedge");
  check_corners(mesh.pyramids, mesh.points.size(), "pyramid");
  check_names(mesh.region_names, "region", "regions");
  check_names(mesh.patch_names, "patch", "patches");
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

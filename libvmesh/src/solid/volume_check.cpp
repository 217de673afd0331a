#include "vmesh/solid/volume_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/volume_faces.h"

#include "solid/wedge_jacobian.h"

namespace vmesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
// Derived: rounding of a determinant of differences, relative to the product of their lengths, is a few units in the
// last place.
constexpr double kRounding = 1e-14;
// Relative error of a sum over all cells.
constexpr double kSumRounding = 1e-9;

/// Collects what is of one kind.
class Finding {
 public:
  Finding(VolumeDefectKind kind, std::string what) : defect_{kind, Vec3::Zero(), 0, {}}, what_(std::move(what)) {}

  void add(const Vec3& position) {
    if (defect_.count++ == 0) defect_.position = position;
  }
  void add_to(std::vector<VolumeDefect>& defects) {
    if (defect_.count == 0) return;
    defect_.message = std::to_string(defect_.count) + " " + what_ + ", the first at " + point_text(defect_.position);
    defects.push_back(defect_);
  }

 private:
  VolumeDefect defect_;
  std::string what_;
};

Kernel::Point_3 point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

bool is_positive(const VolumeMesh& mesh, const Tetrahedron& t) {
  return CGAL::orientation(point(mesh.points[t[0]]), point(mesh.points[t[1]]), point(mesh.points[t[2]]),
                           point(mesh.points[t[3]])) == CGAL::POSITIVE;
}

/// The determinant of a pyramid's map is bilinear over the base, so those at the four corners decide.
bool is_positive(const VolumeMesh& mesh, const Pyramid& p) {
  const auto& [a, b, c, d, e] = p;
  return is_positive(mesh, Tetrahedron{a, b, d, e}) && is_positive(mesh, Tetrahedron{b, c, a, e}) &&
         is_positive(mesh, Tetrahedron{c, d, b, e}) && is_positive(mesh, Tetrahedron{d, a, c, e});
}

bool is_positive(const VolumeMesh& mesh, const Wedge& wedge) {
  WedgeCorners p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = mesh.points[wedge[i]];
  const double base =
      std::max((p[1] - p[0]).norm(), (p[4] - p[3]).norm()) * std::max((p[2] - p[0]).norm(), (p[5] - p[3]).norm());
  const double height = std::max({(p[3] - p[0]).norm(), (p[4] - p[1]).norm(), (p[5] - p[2]).norm()});
  const auto coefficients = jacobian_coefficients(p);
  return *std::min_element(coefficients.begin(), coefficients.end()) > kRounding * base * height;
}

template <class Cell>
bool has_good_corners(const VolumeMesh& mesh, const Cell& cell) {
  return std::all_of(cell.begin(), cell.end(), [&](Index v) { return v < mesh.points.size(); });
}

bool has_good_corners(const VolumeMesh& mesh, const BoundaryFace& face) {
  return std::all_of(face.corners.begin(), face.corners.begin() + 3, [&](Index v) { return v < mesh.points.size(); }) &&
         (face.is_triangle() || face.corners[3] < mesh.points.size());
}

void find_bad_corners(const VolumeMesh& mesh, Finding& finding) {
  const auto examine = [&](const auto& element) {
    if (!has_good_corners(mesh, element)) finding.add(Vec3::Zero());
  };
  for_each_cell(mesh, examine);
  for (const BoundaryFace& face : mesh.boundary) examine(face);
}

/// Of a mesh with corners that exist.
Finding inverted_cells_of(const VolumeMesh& mesh) {
  Finding inverted(VolumeDefectKind::inverted_cell, "cells that are flat or turned over somewhere");
  for_each_cell(mesh, [&](const auto& cell) {
    if (!is_positive(mesh, cell)) inverted.add(mesh.points[cell[0]]);
  });
  return inverted;
}

void find_wrong_labels(const VolumeMesh& mesh, Finding& finding) {
  if (mesh.cell_region.size() != mesh.cell_count()) finding.add(Vec3::Zero());
  for (const Index region : mesh.cell_region) {
    if (region >= mesh.region_names.size()) finding.add(Vec3::Zero());
  }
  for (const BoundaryFace& face : mesh.boundary) {
    if (face.patch >= mesh.patch_names.size()) finding.add(mesh.points[face.corners[0]]);
  }
}

/// A face that begins with its lowest corner, and with the lower of this one's neighbours if `turned`: then it is seen
/// from the other side.
struct Side {
  CellFace corners;
  bool turned;

  auto operator<=>(const Side&) const = default;
};

Side side_of(CellFace face) {
  const std::size_t n = face[3] == kNone ? 3 : 4;
  const auto end = face.begin() + static_cast<std::ptrdiff_t>(n);
  std::rotate(face.begin(), std::min_element(face.begin(), end), end);
  const bool turned = face[1] > face[n - 1];
  if (turned) std::reverse(face.begin() + 1, end);
  return {face, turned};
}

CellFace reversed(const CellFace& face) {
  return face[3] == kNone ? CellFace{face[0], face[2], face[1], kNone} : CellFace{face[0], face[3], face[2], face[1]};
}

/// Of all cells, and of the outside.
std::vector<Side> all_sides(const VolumeMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(4 * mesh.tetrahedra.size() + 5 * (mesh.wedges.size() + mesh.pyramids.size()) + mesh.boundary.size());
  for_each_cell(mesh, [&](const auto& cell) {
    for (const CellFace& face : faces_of(cell)) sides.push_back(side_of(face));
  });
  for (const BoundaryFace& face : mesh.boundary) sides.push_back(side_of(reversed(face.corners)));
  return sides;
}

/// So that equal ones are neighbours: by their lowest corner, which few share, and then among these.
std::vector<Side> sorted(const std::vector<Side>& sides, std::size_t points) {
  std::vector<std::size_t> begin(points + 1, 0);
  for (const Side& side : sides) ++begin[side.corners[0] + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Side> result(sides.size());
  std::vector<std::size_t> next = begin;
  for (const Side& side : sides) result[next[side.corners[0]]++] = side;
  for (std::size_t v = 0; v < points; ++v)
    std::sort(result.begin() + static_cast<std::ptrdiff_t>(begin[v]),
              result.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]));
  return result;
}

/// Every face must have a cell on one side, and a cell or the outside on the other.
void find_unmatched(const VolumeMesh& mesh, Finding& finding) {
  const std::vector<Side> sides = sorted(all_sides(mesh), mesh.points.size());
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].corners == sides[i].corners) ++end;
    if (end != i + 2 || sides[i].turned == sides[i + 1].turned) finding.add(mesh.points[sides[i].corners[0]]);
    i = end;
  }
}

void find_crossings(const VolumeMesh& mesh, Finding& crossing, Finding& unmatched) {
  const TriMesh surface = boundary_surface(mesh).mesh;
  for (const auto& [f, g] : self_intersections(surface)) crossing.add(surface.vertices[surface.faces[f][0]]);
  const Topology topology = measure_topology(surface);
  if (!topology.closed || topology.crowded_edges > 0 || !topology.oriented)
    unmatched.add(surface.vertices.empty() ? Vec3::Zero() : surface.vertices[0]);
}

/// A patch of the surface: its area, and by how much it differs from a plane.
struct PatchMeasures {
  double area = 0;
  Vec3 area_vector = Vec3::Zero();
  double low = 0, high = 0;  // heights along the normal, above a corner

  double unevenness() const { return high - low; }
};

PatchMeasures measure_patch(const VesselWall& wall, Index patch) {
  PatchMeasures measures;
  const Vec3* base = nullptr;
  const auto visit = [&](auto&& visit_face) {
    for (Index f = 0; f < wall.patch.size(); ++f) {
      if (wall.patch[f] == patch) visit_face(f);
    }
  };
  visit([&](Index f) {
    const Vec3 area = area_normal(wall.mesh, f) / 2;
    measures.area += area.norm();
    measures.area_vector += area;
    base = &wall.mesh.vertices[wall.mesh.faces[f][0]];
  });
  visit([&](Index f) {
    for (const Index v : wall.mesh.faces[f]) {
      const double height = measures.area_vector.normalized().dot(wall.mesh.vertices[v] - *base);
      measures.low = std::min(measures.low, height);
      measures.high = std::max(measures.high, height);
    }
  });
  return measures;
}

}  // namespace

std::string_view to_string(VolumeDefectKind kind) {
  switch (kind) {
    case VolumeDefectKind::not_filled:
      return "not_filled";
    case VolumeDefectKind::inverted_cell:
      return "inverted_cell";
    case VolumeDefectKind::not_conforming:
      return "not_conforming";
    case VolumeDefectKind::wrong_label:
      return "wrong_label";
    case VolumeDefectKind::crossing_faces:
      return "crossing_faces";
    case VolumeDefectKind::other_boundary:
      return "other_boundary";
  }
  return "";
}

std::vector<VolumeDefect> find_volume_defects(const VolumeMesh& mesh) {
  std::vector<VolumeDefect> defects;
  Finding corners(VolumeDefectKind::not_conforming, "cells or faces with corners that do not exist");
  find_bad_corners(mesh, corners);
  corners.add_to(defects);
  if (!defects.empty()) return defects;

  Finding inverted = inverted_cells_of(mesh);
  Finding unmatched(VolumeDefectKind::not_conforming, "faces without exactly one cell on either side");
  Finding labels(VolumeDefectKind::wrong_label, "cells or faces without a region or patch");
  Finding crossing(VolumeDefectKind::crossing_faces, "pairs of boundary faces that cross");
  find_unmatched(mesh, unmatched);
  find_wrong_labels(mesh, labels);
  find_crossings(mesh, crossing, unmatched);
  for (Finding* finding : {&inverted, &unmatched, &labels, &crossing}) finding->add_to(defects);
  return defects;
}

VolumeDefect find_inverted_cells(const VolumeMesh& mesh) {
  for_each_cell(mesh, [&](const auto& cell) {
    if (!has_good_corners(mesh, cell)) throw InvalidInput("a cell has corners that do not exist");
  });
  std::vector<VolumeDefect> defects;
  inverted_cells_of(mesh).add_to(defects);
  return defects.empty() ? VolumeDefect{} : defects.front();
}

std::vector<VolumeDefect> compare_with_wall(const VolumeMesh& mesh, std::string_view region, const VesselWall& wall) {
  std::vector<VolumeDefect> defects;
  const VolumeMeasures measures = measure_volume(mesh);
  const auto compare = [&](const std::string& what, double found, double expected, double tolerance) {
    if (std::abs(found - expected) <= tolerance) return;
    defects.push_back({VolumeDefectKind::other_boundary, wall.mesh.vertices[0], 1,
                       what + formatted(" is %.12g, that of the surface %.12g", found, expected)});
  };
  double slack = 0;  // in the volume
  for (Index patch = wall.wall_patches; patch < wall.patch_names.size(); ++patch) {
    const PatchMeasures cap = measure_patch(wall, patch);
    slack += cap.area * cap.unevenness();
    const auto named = std::find(mesh.patch_names.begin(), mesh.patch_names.end(), wall.patch_names[patch]);
    const double found = named == mesh.patch_names.end()
                             ? 0
                             : measures.patch_area_mm2[static_cast<std::size_t>(named - mesh.patch_names.begin())];
    const double slope = cap.area > 0 ? cap.unevenness() / std::sqrt(cap.area) : 0;
    compare("the area of " + wall.patch_names[patch], found, cap.area, (kSumRounding + slope * slope) * cap.area);
  }
  const auto named = std::find(mesh.region_names.begin(), mesh.region_names.end(), region);
  const double volume = named == mesh.region_names.end()
                            ? 0
                            : measures.region_volume_mm3[static_cast<std::size_t>(named - mesh.region_names.begin())];
  const double expected = enclosed_volume(wall.mesh);
  compare("the volume of " + std::string(region), volume, expected, kSumRounding * expected + slack);
  return defects;
}

}  // namespace vmesh

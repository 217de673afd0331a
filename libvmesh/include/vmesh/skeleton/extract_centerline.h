#pragma once

#include <cstddef>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/core/progress.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

struct ExtractOptions {
  /// Distance between nodes along a vessel, in local radii; 0.1 to 10.
  double spacing = 1;
  /// Parts of the surface whose vessels come closer to each other than this times the smaller of their radii are
  /// joined; 0 or more.
  double join = 1;
  /// Keep all parts that remain apart instead of the one with the largest volume.
  bool all_components = false;
  /// Break all loops. Otherwise as many are kept as the surface has handles.
  bool tree = false;
};

/// How far a surface, or a region of it, is from the boundary of the vessel volume, over its area.
struct Coverage {
  double area = 0;                              ///< mm^2
  double mean = 0, percentile_95 = 0, max = 0;  ///< mm
  Vec3 max_at = Vec3::Zero();                   ///< on the surface, mm
};

/// What extraction did, and how well the result represents the surface.
struct ExtractionReport {
  std::size_t parts = 0;         ///< components of the surface that a skeleton was extracted from
  std::size_t joined = 0;        ///< joints between them
  std::size_t left_out = 0;      ///< components left out because they remained apart
  std::size_t spurs = 0;         ///< short branches that were removed
  std::size_t loops_broken = 0;  ///< by removing a segment
  std::size_t merged = 0;        ///< nodes that shared a lumen with a node of another stretch of vessel
  Coverage coverage;             ///< of the surface without the components left out
  /// Of the regions of the surface nearest to each branch, in the order of find_branches().
  std::vector<Coverage> branches;
};

struct ExtractedCenterline {
  Centerline centerline;  ///< in canonical order (see CleaningOptions)
  ExtractionReport report;
};

/// The centerline of a closed surface: curve skeletons by mean curvature flow, spurs shorter than the local radius
/// removed, resampled; then positions and radii are fitted so that the boundary of the union of round cones follows the
/// surface, ends included. Stretches that share one lumen, such as the legs of a hairpin in a wide vessel, are merged.
/// Components that enclose a negative volume (cavities) or almost none are left out; a surface that faces inwards as a
/// whole is turned over. A component of genus g has g loops, unless `tree`. Deterministic. Throws InvalidInput for a
/// surface that is not closed, manifold and oriented, and for options out of range; Unsupported if there is not enough
/// free memory; Cancelled.
ExtractedCenterline extract_centerline(const TriMesh& surface, const ExtractOptions& options = {},
                                       const Progress& progress = {});

}  // namespace vmesh

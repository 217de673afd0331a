#pragma once

#include <vector>

#include "vmesh/surface/generate.h"

namespace vmesh {

/// What becomes of the ends at which a surface was left open.
struct FlatEndOptions {
  /// Scale the rings to the area of the vessel's round cross-section: they are inscribed in it, which at six vertices
  /// around cuts off a sixth. Not for fitted surfaces.
  bool keep_area = true;
  bool cap = true;               ///< close them by flat caps
  std::vector<Index> left_open;  ///< but not at these nodes of the centerline
  /// Length of a straight tube that goes on from every end first, of the same cross-section, in radii: of the circle
  /// of its area. 0: none.
  double extension = 0;
};

/// An end of a vessel where the surface ends flat.
struct FlatEnd {
  /// Rank of the node among all ends of the centerline, from 1: the same whichever of them end flat.
  Index label = 0;
  Index node = kNone;          ///< of the centerline
  Vec3 center = Vec3::Zero();  ///< centroid of the cross-section, mm
  Vec3 normal = Vec3::Zero();  ///< out of the vessel
  double area = 0;             ///< of the cross-section, mm^2
  bool capped = false;         ///< else open
};

struct FlatEnds {
  std::vector<FlatEnd> ends;     ///< ascending in the nodes
  std::vector<Index> cap_label;  ///< of every face: the label of the end that it caps; 0: wall
};

/// Extends and caps the openings of `result`, whose numbers are those of `centerline`. The faces that it had come
/// first. Caps are flat, of triangles about as large as those around them; openings that were closed are
/// no longer listed. Check and defects become those of the new surface; nodes stay inside or outside as they were.
/// Throws InvalidInput for a negative extension.
FlatEnds finish_ends(GenerateResult& result, const Centerline& centerline, const FlatEndOptions& options = {});

}  // namespace vmesh

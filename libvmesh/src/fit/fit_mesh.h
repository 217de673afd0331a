#pragma once

#include <vector>

#include "vmesh/edit/edit_mesh.h"

namespace vmesh::fitting {

/// A vertex of a surface that is fitted.
struct FitVertex {
  Vec3 position = Vec3::Zero();
  Index cone = kNone;     ///< of the vessel field, the nearest one
  Index opening = kNone;  ///< on whose ring the vertex lies
  double size = 0;        ///< intended length of the edges, mm
  double base_size = 0;   ///< size on the surface as given
  Index match = kNone;    ///< a face of the reference that was matched nearby
  /// Direction in which triangles may be longer, times by how much; zero where they are even.
  Vec3 elongation = Vec3::Zero();

  /// Of a vertex at `p` added between two.
  static FitVertex between(const FitVertex& a, const FitVertex& b, const Vec3& p) {
    const double sign = a.elongation.dot(b.elongation) < 0 ? -1 : 1;  // directions have none
    return {p,
            std::min(a.cone, b.cone),
            kNone,
            0.5 * (a.size + b.size),
            0.5 * (a.base_size + b.base_size),
            a.match,
            0.5 * (a.elongation + sign * b.elongation)};
  }
};

using FitMesh = EditMesh<FitVertex>;

inline bool on_border(const FitMesh& surface, Index v) { return surface.vertex(v).opening != kNone; }

/// Whether a vertex must stay as it is: one flag each; vertices newer than the flags are not frozen.
inline bool is_frozen(const std::vector<char>& frozen, Index v) { return v < frozen.size() && frozen[v]; }

}  // namespace vmesh::fitting

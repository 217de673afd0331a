#pragma once

#include <algorithm>

#include "vmesh/mesh/face_pair.h"

namespace vmesh {

/// The plane of a face that is tested against many others: tells cheaply of most of them that the two do not intersect.
class FacePlane {
 public:
  explicit FacePlane(const PlacedFace& face) : vertices_(face.vertices), base_(face.points[0]) {
    const Vec3 first = face.points[1] - base_, second = face.points[2] - base_;
    normal_ = first.cross(second);
    margin_ = kMargin * kMargin * first.squaredNorm() * second.squaredNorm();
  }

  /// Whether the corners of `other` that are not common are certainly on one side, and that there are any: the two
  /// faces then meet at most in what they have in common. The margin is far above the rounding of the determinant.
  bool has_on_one_side(const PlacedFace& other) const {
    int above = 0, below = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (std::find(vertices_.begin(), vertices_.end(), other.vertices[i]) != vertices_.end()) continue;
      const Vec3 away = other.points[i] - base_;
      const double height = normal_.dot(away);
      if (!(height * height > margin_ * away.squaredNorm())) return false;
      ++(height > 0 ? above : below);
    }
    return (above == 0) != (below == 0);
  }

 private:
  // Relative to edges and distance: below, exact predicates decide; rounding is about 1e-15.
  static constexpr double kMargin = 1e-9;

  Triangle vertices_;
  Vec3 base_, normal_;
  double margin_;
};

}  // namespace vmesh

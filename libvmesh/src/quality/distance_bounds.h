#pragma once

#include <array>

#include "quality/triangle_tree.h"

namespace vmesh {

/// A point of the measured mesh with the closest face of the other and its distance.
struct MeasuredPoint {
  Vec3 position;
  NearestFace nearest;
};

/// A triangle of the measured mesh, or a subtriangle of one.
using Piece = std::array<MeasuredPoint, 3>;

/// An upper bound of the distance of any point of `piece` from the other mesh. Bounds are tried from cheap to expensive
/// until one is at most `good_enough`.
double upper_bound(const Piece& piece, const TriangleTree& other, double good_enough);

/// The largest distance of a corner from one face. As that distance is convex, no other point of `piece` is farther.
double single_face_bound(const Piece& piece, const TriangleFrame& face);

}  // namespace vmesh

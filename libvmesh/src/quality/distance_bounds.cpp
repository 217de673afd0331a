#include "quality/distance_bounds.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

// Distances of a piece's corners (rows) from the faces closest to them (columns).
struct DistanceTable {
  Eigen::Matrix3d d;
  int faces = 0;
};

// Every point of a triangle is within this distance of a corner: half the longest edge, or the circumradius if all
// angles are acute, relatively largest for an equilateral triangle.
double covering_radius(double a2, double b2, double c2) {
  const double longest2 = std::max({a2, b2, c2});
  return a2 + b2 + c2 <= 2 * longest2 ? std::sqrt(longest2 / 4) : std::sqrt(longest2 / 3);
}

// From corner distances alone.
double lipschitz_bound(const Piece& piece) {
  const double d0 = piece[0].nearest.distance, d1 = piece[1].nearest.distance, d2 = piece[2].nearest.distance;
  const double opposite0 = (piece[1].position - piece[2].position).squaredNorm();
  const double opposite1 = (piece[2].position - piece[0].position).squaredNorm();
  const double opposite2 = (piece[0].position - piece[1].position).squaredNorm();
  const double from_one =
      std::min({d0 + std::sqrt(std::max(opposite1, opposite2)), d1 + std::sqrt(std::max(opposite0, opposite2)),
                d2 + std::sqrt(std::max(opposite0, opposite1))});
  return std::min(from_one, std::max({d0, d1, d2}) + covering_radius(opposite0, opposite1, opposite2));
}

DistanceTable make_table(const Piece& piece, const TriangleTree& other) {
  DistanceTable table;
  for (int i = 0; i < 3; ++i) {
    const Index face = piece[i].nearest.face;
    bool known = false;
    for (int j = 0; j < i; ++j) known = known || piece[j].nearest.face == face;
    if (known) continue;
    for (int j = 0; j < 3; ++j) {
      table.d(j, table.faces) = piece[j].nearest.face == face
                                    ? piece[j].nearest.distance
                                    : std::sqrt(other.frame(face).squared_distance(piece[j].position));
    }
    ++table.faces;
  }
  return table;
}

// The distance from a face is convex, and so is any mean of such distances: at most its largest value at a corner.
double single_face_bound(const DistanceTable& table) {
  double best = table.d.col(0).maxCoeff();
  for (int t = 1; t < table.faces; ++t) best = std::min(best, table.d.col(t).maxCoeff());
  return best;
}

// No weights do better than this: the weighted mean's largest value is at least its average over the corners.
double limit_of_means(const DistanceTable& table) {
  double least = table.d.col(0).sum();
  for (int t = 1; t < table.faces; ++t) least = std::min(least, table.d.col(t).sum());
  return least / 3;
}

double mean_bound(const DistanceTable& table, int s, int t, double weight) {
  return (weight * table.d.col(s) + (1 - weight) * table.d.col(t)).maxCoeff();
}

// The minimum over all weights of two faces: where two corners' means are equal, unless one face alone does better.
double two_face_bound(const DistanceTable& table, int s, int t, double best) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double gain = (table.d(i, s) - table.d(j, s)) - (table.d(i, t) - table.d(j, t));
    const double weight = (table.d(j, t) - table.d(i, t)) / gain;
    if (weight > 0 && weight < 1) best = std::min(best, mean_bound(table, s, t, weight));
  }
  return best;
}

// The bound with the weights that make the mean equal at all corners, if there are any.
double three_face_bound(const DistanceTable& table, double worse) {
  const Eigen::Matrix3d& d = table.d;
  Vec3 weights = d.row(1).cross(d.row(2)) + d.row(2).cross(d.row(0)) + d.row(0).cross(d.row(1));
  weights /= weights.sum();
  if (!(weights.minCoeff() > 0)) return worse;
  return std::min(worse, (d * weights).maxCoeff());
}

}  // namespace

double single_face_bound(const Piece& piece, const TriangleFrame& face) {
  double squared = 0;
  for (const MeasuredPoint& corner : piece) squared = std::max(squared, face.squared_distance(corner.position));
  return std::sqrt(squared);
}

double upper_bound(const Piece& piece, const TriangleTree& other, double good_enough) {
  double best = lipschitz_bound(piece);
  if (best <= good_enough) return best;
  const DistanceTable table = make_table(piece, other);
  best = std::min(best, single_face_bound(table));
  if (best <= good_enough || table.faces == 1 || limit_of_means(table) > good_enough) return best;
  for (int s = 0; s < table.faces && best > good_enough; ++s) {
    for (int t = s + 1; t < table.faces; ++t) best = two_face_bound(table, s, t, best);
  }
  return best > good_enough && table.faces == 3 ? three_face_bound(table, best) : best;
}

}  // namespace vmesh

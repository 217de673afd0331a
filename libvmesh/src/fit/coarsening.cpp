#include "fit/coarsening.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <tuple>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "vmesh/edit/crossing_guard.h"

#include "fit/guarded_step.h"

namespace vmesh::fitting {
namespace {

using Mat3 = Eigen::Matrix3d;

constexpr double kOutdated = 1.02;    // a step whose cost has grown by this factor waits for its turn
constexpr double kTurn = 0.3;         // least cosine between a face's normals before and after a collapse
constexpr double kHeld = 1e-3;        // of the sum of squares: keeps vertices in directions in which nothing changes
constexpr double kFarthestPlace = 2;  // edge lengths from the middle of an edge: where its vertex may go
// Rounds over which curvature is averaged, an edge each. Measured on three fits: 1 to 6 give the same errors.
constexpr int kRingsAround = 3;

// From the scatter of the normals around: its largest direction is the mean normal, the others are those of curvature,
// in which it grows with the square.
Vec3 elongation_of(const Mat3& scatter, double most) {
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(scatter);  // ascending
  const double least = solver.eigenvalues()[0], middle = solver.eigenvalues()[1];
  if (!(middle > 0)) return Vec3::Zero();
  const double ratio = std::pow(middle / std::max(least, middle * std::pow(most, -4)), 0.25);
  return std::clamp(ratio, 1.0, most) * solver.eigenvectors().col(0);
}

/// Where the end of a collapsed edge goes, and what that costs.
struct Placement {
  Vec3 position = Vec3::Zero();
  double cost = 0;  // squared volume swept, mm^6
};

/// The least squares of the volumes between faces and their new corner, subject to their sum being zero.
class SweptVolume {
 public:
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = (b - a).cross(c - a);  // twice the area
    const double offset = normal.dot(a);
    matrix_ += normal * normal.transpose();
    right_ += offset * normal;
    constant_ += offset * offset;
    sum_ += normal;
    sum_offset_ += offset;
  }

  double at(const Vec3& p) const { return p.dot(matrix_ * p) - 2 * right_.dot(p) + constant_; }

  /// The point of least squares that leaves the enclosed volume as it is, `near` where that makes no difference.
  /// nullopt where all faces are degenerate.
  std::optional<Vec3> best(const Vec3& near) const {
    const double scale = matrix_.trace();
    if (!(scale > 0)) return std::nullopt;
    const Mat3 held = matrix_ + kHeld * scale * Mat3::Identity();
    const Mat3 inverse = held.inverse();
    Vec3 step = inverse * (right_ - matrix_ * near);
    const double stiffness = sum_.dot(inverse * sum_);
    if (stiffness > 0) step += (sum_offset_ - sum_.dot(near + step)) / stiffness * (inverse * sum_);
    return near + step;
  }

 private:
  Mat3 matrix_ = Mat3::Zero();
  Vec3 right_ = Vec3::Zero(), sum_ = Vec3::Zero();
  double constant_ = 0, sum_offset_ = 0;
};

class Coarsener {
 public:
  Coarsener(FitMesh& surface, double max_skewness, const ConeRelations* joints)
      : surface_(surface),
        max_skewness_(max_skewness),
        joints_(joints),
        guard_(
            surface.faces().size(),
            [&surface](Index f) { return surface.has_face(f) ? std::make_optional(surface.placed(f)) : std::nullopt; }),
        count_(surface.vertex_count()) {}

  void run(std::size_t vertices) {
    for (const MeshEdge& e : surface_.edges()) consider(e);
    while (!queue_.empty() && count_ > vertices) {
      const Candidate candidate = queue_.top();
      queue_.pop();
      const auto [expected, a, b] = candidate;
      if (!surface_.has_vertex(a) || !surface_.has_vertex(b) || !surface_.may_collapse({a, b})) continue;
      const std::optional<Placement> placement = place({a, b});
      if (!placement) continue;
      if (placement->cost > kOutdated * expected) {
        queue_.emplace(placement->cost, a, b);
        continue;
      }
      if (collapse({a, b}, *placement)) --count_;
    }
  }

 private:
  using Candidate = std::tuple<double, Index, Index>;

  std::optional<Placement> place(const MeshEdge& e) const {
    SweptVolume swept;
    for (const Index end : {e.a, e.b}) {
      for (const Index f : surface_.faces_around(end)) {
        if (end == e.b && has_corner(surface_.faces()[f], e.a)) continue;  // counted
        const auto [a, b, c] = surface_.corners(f);
        swept.add(a, b, c);
      }
    }
    const Vec3 &a = surface_.position(e.a), &b = surface_.position(e.b), middle = 0.5 * (a + b);
    std::optional<Vec3> p = swept.best(middle);
    if (!p || !((*p - middle).norm() <= kFarthestPlace * (a - b).norm())) p = middle;
    return Placement{*p, std::max(0.0, swept.at(*p))};
  }

  void consider(const MeshEdge& e) {
    if (on_border(surface_, e.a) || on_border(surface_, e.b)) return;
    if (const auto placement = place(e)) queue_.emplace(placement->cost, std::min(e.a, e.b), std::max(e.a, e.b));
  }

  bool collapse(const MeshEdge& e, const Placement& placement) {
    const FitVertex &a = surface_.vertex(e.a), &b = surface_.vertex(e.b);
    FitVertex target = FitVertex::between(a, b, placement.position);
    target.cone =
        (placement.position - a.position).norm() <= (placement.position - b.position).norm() ? a.cone : b.cone;
    const FitMesh::Step step = surface_.collapsing(e.b, e.a, target);
    if (!keeps_shapes(step) || !keeps_joints(step)) return false;
    std::vector<PlacedFace> faces;
    for (const Triangle& f : step.faces) faces.push_back(surface_.placed(f, step));
    if (!guard_.allows(faces, step.gone)) return false;
    surface_.take(step);
    for (const Index f : step.gone) guard_.touch(f);
    std::vector<Index> near;
    surface_.neighbours(e.a, near);
    for (const Index w : near) consider({e.a, w});
    return true;
  }

  bool keeps_shapes(const FitMesh::Step& step) const {
    double worst = max_skewness_;
    bool known = false;  // how skew the faces are that are replaced
    for (std::size_t i = 0; i < step.faces.size(); ++i) {
      const auto [p, q, r] = surface_.placed(step.faces[i], step).points;
      const Vec3 normal = (q - p).cross(r - p);
      if (!(normal.dot(surface_.unit_normal(step.gone[i])) > kTurn * normal.norm())) return false;
      const double skewness = skewness_after(surface_, step.faces[i], step);
      if (skewness <= worst) continue;
      if (known) return false;
      known = true;
      for (const Index f : step.gone) worst = std::max(worst, skewness_of(surface_, f));
      if (skewness > worst) return false;
    }
    return true;
  }

  bool keeps_joints(const FitMesh::Step& step) const {
    if (!joints_) return true;
    return std::all_of(step.faces.begin(), step.faces.end(), [&](const Triangle& face) {
      return std::all_of(face.begin(), face.end(),
                         [&](Index v) { return v == step.vertex || keeps_joints(step.target, surface_.vertex(v)); });
    });
  }

  // Whether an edge between the two may be.
  bool keeps_joints(const FitVertex& a, const FitVertex& b) const {
    if ((a.position - b.position).norm() <= std::max(a.base_size, b.base_size)) return true;
    if (!are_adjacent(a.cone, b.cone)) return false;
    const double longest = std::max(length_of(a.cone), length_of(b.cone));
    return (place_of(a) - place_of(b)).norm() <= longest;
  }

  bool are_adjacent(Index i, Index j) const {
    return joints_->first_node(i) == joints_->first_node(j) || joints_->first_node(i) == joints_->last_node(j) ||
           joints_->last_node(i) == joints_->first_node(j) || joints_->last_node(i) == joints_->last_node(j);
  }
  double length_of(Index cone) const { return (joints_->axis_point(cone, 1) - joints_->axis_point(cone, 0)).norm(); }
  Vec3 place_of(const FitVertex& v) const {
    return joints_->axis_point(v.cone, joints_->sample_cone(v.position, v.cone).t);
  }

  FitMesh& surface_;
  double max_skewness_;
  const ConeRelations* joints_;
  CrossingGuard guard_;
  std::size_t count_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
};

}  // namespace

void find_elongation(FitMesh& surface, double most) {
  const std::size_t count = surface.vertices().size();
  std::vector<Mat3> scatter(count, Mat3::Zero());
  for (Index f = 0; f < surface.faces().size(); ++f) {
    const Vec3 normal = surface.area_normal(f);
    if (!(normal.norm() > 0)) continue;
    const Mat3 square = normal * normal.transpose() / normal.norm();
    for (const Index v : surface.faces()[f]) scatter[v] += square;
  }
  for (int i = 0; i < kRingsAround; ++i) {
    const std::vector<Mat3> before = scatter;
    for (Index f = 0; f < surface.faces().size(); ++f) {
      for (const Index v : surface.faces()[f]) {
        for (const Index w : surface.faces()[f]) {
          if (v != w) scatter[v] += before[w];
        }
      }
    }
  }
  for (Index v = 0; v < count; ++v) surface.edit(v).elongation = elongation_of(scatter[v], most);
}

void coarsen(FitMesh& surface, std::size_t vertices, double max_skewness, const ConeRelations* joints) {
  Coarsener(surface, max_skewness, joints).run(vertices);
}

}  // namespace vmesh::fitting

#include "fit/least_squares.h"

#include <cmath>

#include <Eigen/LU>

namespace vmesh::fitting {
namespace {

using Mat3 = Eigen::Matrix3d;

constexpr double kHold = 1e-3;      // of a vertex's area: keeps vertices without matches in place
constexpr double kInPlane = 100;    // of a vertex's area
constexpr double kFrozen = 1e4;     // of a vertex's area: the remaining step is dropped
constexpr double kAccuracy = 1e-5;  // of the residual, scaled by each vertex's stiffness
// Large distances count more, up to this many times the RMS distance, so that distant regions are brought near.
constexpr double kMostEmphasized = 4;
constexpr int kMostIterations = 200;

// The normal equations of the steps.
class Equations {
 public:
  explicit Equations(const FitMesh& surface)
      : surface_(surface), faces_(surface.faces().size()), right_(surface.vertices().size(), Vec3::Zero()) {
    diagonal_.assign(surface.vertices().size(), Mat3::Zero());
  }

  void add(const Match& match, double weight) {
    const Triangle& face = surface_.faces()[match.face];
    const Mat3 square = weight * match.direction * match.direction.transpose();
    const Vec3 pull = -weight * match.distance * match.direction;
    for (int i = 0; i < 3; ++i) {
      diagonal_[face[i]] += match.weights[i] * match.weights[i] * square;
      faces_[match.face][i] += match.weights[(i + 1) % 3] * match.weights[(i + 2) % 3] * square;
      right_[face[i]] += match.weights[i] * pull;
    }
  }

  // Adds the term `square` (step - target)^2.
  void add(Index v, const Mat3& square, const Vec3& target) {
    diagonal_[v] += square;
    right_[v] += square * target;
  }

  // Adds a term for the difference of the steps at the ends of the side of face f opposite to corner i.
  void add_difference(Index f, int i, const Mat3& square) {
    const Triangle& face = surface_.faces()[f];
    diagonal_[face[(i + 1) % 3]] += square;
    diagonal_[face[(i + 2) % 3]] += square;
    faces_[f][i] -= square;
  }

  // Conjugate gradients with a block Jacobi preconditioner, without assembling the matrix: each is solved only once, in
  // few iterations, so assembly would take longer.
  std::vector<Vec3> solve() const {
    const std::size_t count = diagonal_.size();
    std::vector<Mat3> inverse(count);
    for (Index v = 0; v < count; ++v) inverse[v] = diagonal_[v].inverse();
    std::vector<Vec3> steps(count, Vec3::Zero()), residual = right_, direction(count), product(count);
    for (Index v = 0; v < count; ++v) direction[v] = inverse[v] * residual[v];
    double energy = dot(residual, direction);
    const double enough = kAccuracy * kAccuracy * energy;
    for (int i = 0; i < kMostIterations && energy > enough; ++i) {
      multiply(direction, product);
      const double length = energy / dot(direction, product);
      double next_energy = 0;
      for (Index v = 0; v < count; ++v) {
        steps[v] += length * direction[v];
        residual[v] -= length * product[v];
        next_energy += residual[v].dot(inverse[v] * residual[v]);
      }
      const double share = next_energy / energy;
      energy = next_energy;
      for (Index v = 0; v < count; ++v) direction[v] = inverse[v] * residual[v] + share * direction[v];
    }
    return steps;
  }

 private:
  static double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
    return sum;
  }

  void multiply(const std::vector<Vec3>& x, std::vector<Vec3>& product) const {
    for (Index v = 0; v < x.size(); ++v) product[v] = diagonal_[v] * x[v];
    for (Index f = 0; f < faces_.size(); ++f) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Index v = surface_.faces()[f][(i + 1) % 3], w = surface_.faces()[f][(i + 2) % 3];
        product[v] += faces_[f][i] * x[w];  // blocks are symmetric
        product[w] += faces_[f][i] * x[v];
      }
    }
  }

  const FitMesh& surface_;
  std::vector<Mat3> diagonal_;
  struct Sides : std::array<Mat3, 3> {
    Sides() { fill(Mat3::Zero()); }
  };
  std::vector<Sides> faces_;  // blocks of a face's sides, each opposite to a corner
  std::vector<Vec3> right_;
};

template <class Visit>
void for_each_match(const Matches& matches, Visit&& visit) {
  for (const auto* list : {&matches.from_surface, &matches.from_reference}) {
    for (const Match& match : *list) {
      if (match.face != kNone) visit(match);
    }
  }
}

}  // namespace

void keep_in_opening(const FitMesh& surface, Index v, const std::vector<Vec3>& opening_normals, Vec3& step) {
  if (!on_border(surface, v)) return;
  const Vec3& across = opening_normals[surface.vertices()[v].opening];
  step -= across.dot(step) * across;
}

double rms_distance(const Matches& matches) {
  double sum = 0, area = 0;
  for_each_match(matches, [&](const Match& match) {
    sum += match.area * match.distance * match.distance;
    area += match.area;
  });
  return area > 0 && sum > 0 ? std::sqrt(sum / area) : 1;
}

std::vector<Vec3> least_squares_steps(const FitMesh& surface, const Matches& matches,
                                      const std::vector<ShapePull>& pulls, const std::vector<Vec3>& opening_normals,
                                      const std::vector<char>& frozen, const LeastSquaresWeights& weights) {
  Equations equations(surface);
  const double rms = rms_distance(matches);
  for_each_match(matches, [&](const Match& match) {
    const double emphasis = 1 + weights.emphasis * std::min(kMostEmphasized, std::abs(match.distance) / rms);
    equations.add(match, match.area * emphasis);
  });
  std::vector<double> area(surface.vertices().size(), 0);
  std::vector<Vec3> normal(surface.vertices().size(), Vec3::Zero());
  for (Index f = 0; f < surface.faces().size(); ++f) {
    const Vec3 face_normal = surface.area_normal(f);
    for (const Index v : surface.faces()[f]) {
      normal[v] += face_normal;
      area[v] += face_normal.norm() / 3;  // both ways: twice a third of the area
    }
  }
  for (Vec3& n : normal) n.normalize();
  for (Index v = 0; v < surface.vertices().size(); ++v) {
    const Mat3 along = normal[v] * normal[v].transpose();
    const double tangential = weights.tangential * pulls[v].weight;
    equations.add(v, tangential * area[v] * (Mat3::Identity() - along), pulls[v].step);
    const double hold = is_frozen(frozen, v) ? kFrozen : kHold;
    equations.add(v, hold * area[v] * Mat3::Identity(), Vec3::Zero());
    if (on_border(surface, v)) {
      const Vec3& across = opening_normals[surface.vertices()[v].opening];
      equations.add(v, kInPlane * area[v] * across * across.transpose(), Vec3::Zero());
    }
  }
  for (Index f = 0; f < surface.faces().size(); ++f) {
    const Vec3 n = surface.unit_normal(f);
    const Mat3 square = weights.smooth * surface.area_normal(f).norm() / 3 * n * n.transpose();
    for (int i = 0; i < 3; ++i) equations.add_difference(f, i, square);
  }
  std::vector<Vec3> steps = equations.solve();
  for (Index v = 0; v < surface.vertices().size(); ++v) {
    if (is_frozen(frozen, v)) steps[v].setZero();
    keep_in_opening(surface, v, opening_normals, steps[v]);
  }
  return steps;
}

}  // namespace vmesh::fitting

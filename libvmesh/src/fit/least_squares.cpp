#include "fit/least_squares.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

namespace vmesh {
namespace {

using Mat3 = Eigen::Matrix3d;

constexpr double kHold = 1e-3;      // of a vertex' area: keeps what no match holds
constexpr double kInPlane = 100;    // of a vertex' area
constexpr double kFrozen = 1e4;     // of a vertex' area: what is left of its step is dropped
constexpr double kAccuracy = 1e-4;  // of the residual; steps are corrected in the next round anyway
// Large distances count more, up to this many times the RMS distance: what is far off is brought near.
constexpr double kEmphasis = 0.8;
constexpr double kMostEmphasized = 4;
constexpr int kMostIterations = 200;

// The normal equations of the steps.
class Equations {
 public:
  explicit Equations(const FitMesh& surface)
      : surface_(surface), faces_(surface.faces.size()), right_(Eigen::VectorXd::Zero(3 * surface.vertices.size())) {
    diagonal_.assign(surface.vertices.size(), Mat3::Zero());
  }

  void add(const Match& match, double weight) {
    const Triangle& face = surface_.faces[match.face];
    const Mat3 square = weight * match.direction * match.direction.transpose();
    const Vec3 pull = -weight * match.distance * match.direction;
    for (int i = 0; i < 3; ++i) {
      diagonal_[face[i]] += match.weights[i] * match.weights[i] * square;
      faces_[match.face][i] += match.weights[(i + 1) % 3] * match.weights[(i + 2) % 3] * square;
      right_.segment<3>(3 * face[i]) += match.weights[i] * pull;
    }
  }

  // Weight of the step's components: `square` (step - target)^2.
  void add(Index v, const Mat3& square, const Vec3& target) {
    diagonal_[v] += square;
    right_.segment<3>(3 * v) += square * target;
  }

  // Weight of the difference of the steps at the ends of the side of face f that is opposite to corner i.
  void add_difference(Index f, int i, const Mat3& square) {
    const Triangle& face = surface_.faces[f];
    diagonal_[face[(i + 1) % 3]] += square;
    diagonal_[face[(i + 2) % 3]] += square;
    faces_[f][i] -= square;
  }

  std::vector<Vec3> solve() const {
    const Eigen::SparseMatrix<double> matrix = assemble();
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(kAccuracy);
    solver.setMaxIterations(kMostIterations);
    solver.compute(matrix);
    const Eigen::VectorXd solution = solver.solve(right_);
    std::vector<Vec3> steps;
    for (std::size_t v = 0; v < diagonal_.size(); ++v)
      steps.emplace_back(solution.segment<3>(3 * static_cast<Eigen::Index>(v)));
    return steps;
  }

 private:
  Eigen::SparseMatrix<double> assemble() const {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(9 * diagonal_.size() + 54 * faces_.size());
    const auto add_block = [&](Index v, Index w, const Mat3& block) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
          entries.emplace_back(static_cast<int>(3 * v + i), static_cast<int>(3 * w + j), block(i, j));
      }
    };
    for (Index v = 0; v < diagonal_.size(); ++v) add_block(v, v, diagonal_[v]);
    for (Index f = 0; f < faces_.size(); ++f) {
      for (int i = 0; i < 3; ++i) {
        const Index v = surface_.faces[f][(i + 1) % 3], w = surface_.faces[f][(i + 2) % 3];
        add_block(v, w, faces_[f][i]);
        add_block(w, v, faces_[f][i]);
      }
    }
    const auto size = 3 * static_cast<Eigen::Index>(diagonal_.size());
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  const FitMesh& surface_;
  std::vector<Mat3> diagonal_;
  struct Sides : std::array<Mat3, 3> {
    Sides() { fill(Mat3::Zero()); }
  };
  std::vector<Sides> faces_;  // of a face's sides, each opposite to a corner
  Eigen::VectorXd right_;
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

double rms_distance(const Matches& matches) {
  double sum = 0, area = 0;
  for_each_match(matches, [&](const Match& match) {
    sum += match.area * match.distance * match.distance;
    area += match.area;
  });
  return area > 0 && sum > 0 ? std::sqrt(sum / area) : 1;
}

std::vector<Vec3> least_squares_steps(const FitMesh& surface, const Matches& matches, const std::vector<Vec3>& pull,
                                      const std::vector<Vec3>& opening_normals, const std::vector<char>& frozen,
                                      const LeastSquaresWeights& weights) {
  Equations equations(surface);
  const double rms = rms_distance(matches);
  for_each_match(matches, [&](const Match& match) {
    const double emphasis = 1 + kEmphasis * std::min(kMostEmphasized, std::abs(match.distance) / rms);
    equations.add(match, match.area * emphasis);
  });
  std::vector<double> area(surface.vertices.size(), 0);
  std::vector<Vec3> normal(surface.vertices.size(), Vec3::Zero());
  for (Index f = 0; f < surface.faces.size(); ++f) {
    const Vec3 face_normal = surface.area_normal(f);
    for (const Index v : surface.faces[f]) {
      normal[v] += face_normal;
      area[v] += face_normal.norm() / 3;  // both ways: twice a third of the area
    }
  }
  for (Vec3& n : normal) n.normalize();
  for (Index v = 0; v < surface.vertices.size(); ++v) {
    const Mat3 along = normal[v] * normal[v].transpose();
    equations.add(v, weights.tangential * area[v] * (Mat3::Identity() - along), pull[v]);
    const double hold = is_frozen(frozen, v) ? kFrozen : kHold;
    equations.add(v, hold * area[v] * Mat3::Identity(), Vec3::Zero());
    if (surface.on_border(v)) {
      const Vec3& across = opening_normals[surface.vertices[v].opening];
      equations.add(v, kInPlane * area[v] * across * across.transpose(), Vec3::Zero());
    }
  }
  for (Index f = 0; f < surface.faces.size(); ++f) {
    const Vec3 n = surface.unit_normal(f);
    const Mat3 square = weights.smooth * surface.area_normal(f).norm() / 3 * n * n.transpose();
    for (int i = 0; i < 3; ++i) equations.add_difference(f, i, square);
  }
  std::vector<Vec3> steps = equations.solve();
  for (Index v = 0; v < surface.vertices.size(); ++v) {
    if (is_frozen(frozen, v)) steps[v].setZero();
    if (!surface.on_border(v)) continue;
    const Vec3& across = opening_normals[surface.vertices[v].opening];
    steps[v] -= across.dot(steps[v]) * across;
  }
  return steps;
}

}  // namespace vmesh

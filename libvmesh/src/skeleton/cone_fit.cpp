#include "cone_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include "vmesh/volume/vessel_field.h"

namespace vmesh::skeleton {
namespace {

using Vector4 = Eigen::Vector4d;  // displacement and change of radius of a node
using Matrix4 = Eigen::Matrix4d;

// Relative to a node's own weight, which is the area of its samples.
constexpr double kSmoothPosition = 0.03;
constexpr double kSmoothRadius = 0.1;
constexpr double kDamping = 0.02;
// Sliding along the vessel changes hardly anything except the spacing of nodes.
constexpr double kDampingAlong = 1;
constexpr double kDampingOfFixed = 1e6;  // makes nodes practically immovable
constexpr int kAround = 2;               // edges from a merged node to the nodes that are refitted with it
// Distance, in local radii, at which samples farther off are counted.
constexpr double kNear = 0.5;
constexpr double kRadiusFactor = 2;

/// Normal equations of one round, a 4 x 4 block per pair of nodes.
class Equations {
 public:
  explicit Equations(std::size_t nodes)
      : weight_(nodes, 0), side_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(4 * nodes))) {}

  void add_block(Index a, Index b, const Matrix4& block) {
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        if (block(i, j) != 0)
          entries_.emplace_back(static_cast<int>(4 * a) + i, static_cast<int>(4 * b) + j, block(i, j));
  }
  void add_side(Index a, const Vector4& side) { side_.segment<4>(4 * a) += side; }

  /// Adds weight * (sum of factors * states - wanted)^2, states being the unknowns of the nodes, component by
  /// component.
  void add_term(const std::vector<std::pair<Index, double>>& factors, const Vector4& weights, const Vector4& wanted) {
    for (const auto& [a, fa] : factors) {
      add_side(a, fa * weights.cwiseProduct(wanted));
      for (const auto& [b, fb] : factors) add_block(a, b, Matrix4((fa * fb * weights).asDiagonal()));
    }
  }

  std::vector<double>& weight() { return weight_; }

  Eigen::VectorXd solve() const {
    const auto size = side_.size();
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    return solver.solve(side_);
  }

 private:
  std::vector<double> weight_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd side_;
};

/// Sums over the samples of one cone: the blocks (2 x 2) and right-hand sides of its two nodes.
struct ConeSums {
  std::array<Matrix4, 3> blocks = {Matrix4::Zero(), Matrix4::Zero(), Matrix4::Zero()};  // aa, ab, bb
  std::array<Vector4, 2> sides = {Vector4::Zero(), Vector4::Zero()};
  std::array<double, 2> weight = {0, 0};
};

void add_samples(Equations& equations, const VesselField& field, const SurfaceSamples& samples) {
  std::vector<ConeSums> sums(field.cone_count());
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const FieldSample s = field.sample_global(samples.points[i]);
    const double near = kNear * field.radius_at(s.cone, s.t);
    const double weight = samples.areas[i] * std::min(1.0, near / std::max(std::abs(s.distance), 1e-12));
    // The distance is stationary in the touching sphere's position along the axis, so the derivatives are those of that
    // sphere.
    Vector4 derivative;
    derivative << s.gradient, 1;
    const Matrix4 block = weight * derivative * derivative.transpose();
    const Vector4 side = weight * s.distance * derivative;
    ConeSums& sum = sums[s.cone];
    sum.blocks[0] += (1 - s.t) * (1 - s.t) * block;
    sum.blocks[1] += s.t * (1 - s.t) * block;
    sum.blocks[2] += s.t * s.t * block;
    sum.sides[0] += (1 - s.t) * side;
    sum.sides[1] += s.t * side;
    sum.weight[0] += (1 - s.t) * weight;
    sum.weight[1] += s.t * weight;
  }
  for (Index cone = 0; cone < sums.size(); ++cone) {
    const Index a = field.first_node(cone), b = field.last_node(cone);
    const ConeSums& sum = sums[cone];
    equations.add_block(a, a, sum.blocks[0]);
    equations.add_block(b, b, sum.blocks[2]);
    equations.add_block(a, b, sum.blocks[1]);
    equations.add_block(b, a, sum.blocks[1]);
    equations.add_side(a, sum.sides[0]);
    equations.add_side(b, sum.sides[1]);
    equations.weight()[a] += sum.weight[0];
    equations.weight()[b] += sum.weight[1];
  }
}

Vector4 state(const Node& node) {
  Vector4 result;
  result << node.position, node.radius;
  return result;
}

void add_priors(Equations& equations, const Graph& graph, const std::vector<char>& fixed) {
  const auto edges_at = incidence(graph);
  double mean = 0;
  for (const double w : equations.weight()) mean += w / static_cast<double>(graph.nodes.size());
  for (Index n = 0; n < graph.nodes.size(); ++n) {
    const double weight = equations.weight()[n] + 0.05 * mean;  // nodes deep inside others have no samples
    if (fixed[n]) {
      equations.add_block(n, n, Matrix4::Identity() * (kDampingOfFixed * weight));
      continue;
    }
    Matrix4 damping = Matrix4::Identity() * (kDamping * weight);
    if (edges_at[n].size() == 2) {
      const Index a = other_end(graph, edges_at[n][0], n), b = other_end(graph, edges_at[n][1], n);
      const Vector4 bend = state(graph.nodes[n]) - 0.5 * (state(graph.nodes[a]) + state(graph.nodes[b]));
      const Vector4 weights = weight * Vector4(kSmoothPosition, kSmoothPosition, kSmoothPosition, kSmoothRadius);
      equations.add_term({{n, 1.0}, {a, -0.5}, {b, -0.5}}, weights, -bend);
      const Vec3 along = (graph.nodes[b].position - graph.nodes[a].position).normalized();
      damping.topLeftCorner<3, 3>() += kDampingAlong * weight * along * along.transpose();
    }
    equations.add_block(n, n, damping);
  }
}

/// Applies a step, cut to half a radius; radii stay within a factor of their first values, so that nodes without
/// samples of their own cannot vanish. Returns the largest change relative to the radius.
double apply(Graph& graph, const std::vector<Node>& first, const std::vector<char>& fixed,
             const Eigen::VectorXd& step) {
  double most = 0;
  for (Index n = 0; n < graph.nodes.size(); ++n) {
    if (fixed[n]) continue;
    Node& node = graph.nodes[n];
    const double limit = 0.5 * node.radius;
    Vec3 move = step.segment<3>(4 * n);
    if (move.norm() > limit) move *= limit / move.norm();
    const double wanted = node.radius + std::clamp(step[4 * n + 3], -limit, limit);
    const double change =
        std::clamp(wanted, first[n].radius / kRadiusFactor, first[n].radius * kRadiusFactor) - node.radius;
    most = std::max({most, move.norm() / node.radius, std::abs(change) / node.radius});
    node.position += move;
    node.radius += change;
  }
  return most;
}

void fit(Graph& graph, const std::vector<char>& fixed, const SurfaceSamples& samples, int rounds) {
  constexpr double kSettled = 1e-3;
  const std::vector<Node> first = graph.nodes;
  for (int round = 0; round < rounds; ++round) {
    const Centerline centerline = to_centerline(graph);
    const VesselField field(centerline);
    Equations equations(graph.nodes.size());
    add_samples(equations, field, samples);
    add_priors(equations, graph, fixed);
    if (apply(graph, first, fixed, equations.solve()) < kSettled) return;
  }
}

}  // namespace

SurfaceSamples samples_of(const TriMesh& mesh) {
  SurfaceSamples samples;
  std::unordered_map<std::uint64_t, std::size_t> number;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const double share = 0.5 * area_normal(mesh, f).norm() / 3;
    for (int c = 0; c < 3; ++c) {
      const auto [a, b] = std::minmax(mesh.faces[f][c], mesh.faces[f][(c + 1) % 3]);
      const auto [it, fresh] = number.try_emplace(std::uint64_t{a} << 32 | b, samples.points.size());
      if (fresh) {
        samples.points.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
        samples.areas.push_back(0);
      }
      samples.areas[it->second] += share;
    }
  }
  return samples;
}

Centerline to_centerline(const Graph& graph) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (const Node& node : graph.nodes) nodes.push_back({node.position, node.radius});
  for (const auto& [a, b] : graph.edges) segments.push_back({a, b});
  return {std::move(nodes), std::move(segments)};
}

void fit_cones(Graph& graph, const SurfaceSamples& samples, int rounds) {
  fit(graph, std::vector<char>(graph.nodes.size(), 0), samples, rounds);
}

void fit_merged_cones(Graph& graph, const SurfaceSamples& samples, int rounds) {
  std::vector<char> fixed(graph.nodes.size(), 1);
  for (Index n = 0; n < fixed.size(); ++n) {
    if (graph.nodes[n].merged) fixed[n] = 0;
  }
  for (int i = 0; i < kAround; ++i) {
    const std::vector<char> before = fixed;
    for (const auto& [a, b] : graph.edges) {
      if (!before[a] || !before[b]) fixed[a] = fixed[b] = 0;
    }
  }
  fit(graph, fixed, samples, rounds);
}

}  // namespace vmesh::skeleton

#include "cone_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <tbb/parallel_for.h>

#include "vmesh/core/ascending.h"
#include "vmesh/core/box_tree.h"

namespace vmesh::skeleton {
namespace {

using Vector4 = Eigen::Vector4d;  // displacement and change of radius of a node
using Matrix4 = Eigen::Matrix4d;
using Place = GraphCones::Place;

constexpr double kSpacing = 1;     // of nodes for which the weights of bends hold, radii
constexpr double kDamping = 0.02;  // relative to a node's own weight
// Sliding along the vessel changes hardly anything except the spacing of nodes.
constexpr double kDampingAlong = 1;
constexpr double kDampingOfFixed = 1e6;  // makes nodes practically immovable
// Distance, in local radii, at which samples farther off are counted.
constexpr double kNear = 0.5;
constexpr double kRadiusFactor = 2;
// A bump of a vessel sticks out by up to this share of the vessel's radius; a wide one, by up to this share and by up
// to this times its own radius.
constexpr double kBump = 0.35, kWideBump = 0.8, kBumpWidths = 1.5;
constexpr double kWithinSlack = 0.15;  // weight of a sample's distance within its slack

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
  void add_term(const std::array<std::pair<Index, double>, 3>& factors, const Vector4& weights, const Vector4& wanted) {
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

/// Sums over the samples of one cone: the blocks and right-hand sides of its two nodes.
struct ConeSums {
  std::array<Matrix4, 3> blocks = {Matrix4::Zero(), Matrix4::Zero(), Matrix4::Zero()};  // aa, ab, bb
  std::array<Vector4, 2> sides = {Vector4::Zero(), Vector4::Zero()};
  std::array<double, 2> weight = {0, 0};
};

/// A sample in the normal equations: its weight, and the weight times how far the boundary is from where it should be.
struct SampleTerm {
  double weight = 0, pull = 0;
};

SampleTerm term_of(const FitSamples& samples, std::size_t i, double distance, double radius) {
  const double slack = samples.slack[i], near = std::max(kNear * radius, slack), off = std::abs(distance);
  const double weight = samples.areas[i] * std::min(1.0, near / std::max(off, 1e-12));
  // Beyond the slack, the distance beyond it; within, a little of the distance.
  const double beyond = off > slack ? 1 : 0;
  const double pull = std::copysign(beyond * (off - slack), distance) + kWithinSlack * distance;
  return {weight * (beyond + kWithinSlack), weight * pull};
}

SampleTerm term_of(const FitVoxels& voxels, std::size_t i, double distance, double radius) {
  constexpr double kSure = 12, kSmall = 1e-3;  // in blurs: beyond the first, exp() is nothing; below, tanh(x) is x
  const double x = distance / voxels.blur;
  const bool is_inside = voxels.inside[i];
  if (is_inside ? x < -kSure : x > kSure) return {};
  const double likely_inside = 1 / (1 + std::exp(std::clamp(x, -kSure, kSure)));
  const double nearness =
      std::min(1.0, std::max(kNear * radius, 3 * voxels.blur) / std::max(std::abs(distance), 1e-12));
  const double bound = std::abs(x) < kSmall ? 0.25 : std::tanh(0.5 * std::abs(x)) / (2 * std::abs(x));
  const double weight = nearness * voxels.volume;
  return {weight * bound / voxels.blur, weight * ((is_inside ? 1 : 0) - likely_inside)};
}

void add_sample(ConeSums& sum, const RoundCone& cone, const Place& place, const Vec3& point, const SampleTerm& term) {
  // The distance is stationary in the touching sphere's position along the axis, so the derivatives are those of that
  // sphere.
  Vector4 derivative;
  derivative << cone.gradient(point, place.t), 1;
  const Matrix4 block = term.weight * derivative * derivative.transpose();
  const Vector4 side = term.pull * derivative;
  const double t = place.t;
  sum.blocks[0] += (1 - t) * (1 - t) * block;
  sum.blocks[1] += t * (1 - t) * block;
  sum.blocks[2] += t * t * block;
  sum.sides[0] += (1 - t) * side;
  sum.sides[1] += t * side;
  sum.weight[0] += (1 - t) * term.weight;
  sum.weight[1] += t * term.weight;
}

template <class Samples>
void add_samples(Equations& equations, const GraphCones& cones, const Samples& samples,
                 const std::vector<Place>& places) {
  std::vector<ConeSums> sums(cones.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Place& place = places[i];
    const SampleTerm term = term_of(samples, i, place.distance, cones.radius_at(place));
    if (term.weight > 0) add_sample(sums[place.cone], cones.cone(place.cone), place, samples.points[i], term);
  }
  for (Index cone = 0; cone < sums.size(); ++cone) {
    const Index a = cones.first_node(cone), b = cones.last_node(cone);
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

double noise_of(const FitSamples& samples, const std::vector<Place>& places, const GraphCones& cones) {
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double beyond = std::max(std::abs(places[i].distance) - samples.slack[i], 0.0);
    if (beyond > kNear * cones.radius_at(places[i])) continue;
    sum += samples.areas[i] * beyond * beyond;
    area += samples.areas[i];
  }
  return area > 0 ? std::sqrt(sum / area) : 0;
}

Vector4 state(const Node& node) {
  Vector4 result;
  result << node.position, node.radius;
  return result;
}

void add_priors(Equations& equations, const Graph& graph, const std::vector<std::vector<Index>>& edges_at,
                const FitRounds& rounds) {
  const double stiffness = std::pow(kSpacing / rounds.spacing, 4);  // a bend shrinks with the square of the spacing
  double mean = 0;
  for (const double w : equations.weight()) mean += w / static_cast<double>(graph.nodes.size());
  for (Index n = 0; n < graph.nodes.size(); ++n) {
    const double weight = equations.weight()[n] + 0.05 * mean;  // nodes deep inside others have no samples
    if (graph.nodes[n].fixed) {
      equations.add_block(n, n, Matrix4::Identity() * (kDampingOfFixed * weight));
      continue;
    }
    Matrix4 damping = Matrix4::Identity() * (kDamping * weight);
    if (edges_at[n].size() == 2) {
      const Index a = other_end(graph, edges_at[n][0], n), b = other_end(graph, edges_at[n][1], n);
      const Vector4 bend = state(graph.nodes[n]) - 0.5 * (state(graph.nodes[a]) + state(graph.nodes[b]));
      const double rough = rounds.voxel / graph.nodes[n].radius;
      const Vector4 weights =
          weight * stiffness * (1 + rounds.rough * rough * rough) *
          Vector4(rounds.smooth_position, rounds.smooth_position, rounds.smooth_position, rounds.smooth_radius);
      equations.add_term({{{n, 1.0}, {a, -0.5}, {b, -0.5}}}, weights, -bend);
      const Vec3 along = (graph.nodes[b].position - graph.nodes[a].position).normalized();
      damping.topLeftCorner<3, 3>() += kDampingAlong * weight * along * along.transpose();
    }
    equations.add_block(n, n, damping);
  }
}

/// Applies a step, cut to half a radius; radii stay within a factor of their first values, so that nodes without
/// samples of their own cannot vanish. Returns the largest change relative to the radius.
double apply(Graph& graph, const std::vector<Node>& first, const Eigen::VectorXd& step) {
  double most = 0;
  for (Index n = 0; n < graph.nodes.size(); ++n) {
    Node& node = graph.nodes[n];
    if (node.fixed) continue;
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

}  // namespace

GraphCones::GraphCones(const Graph& graph) {
  const auto node = [&](Index n) { return CenterlineNode{graph.nodes[n].position, graph.nodes[n].radius}; };
  const auto edges_at = incidence(graph);
  ends_.assign(graph.edges.begin(), graph.edges.end());
  for (Index n = 0; n < graph.nodes.size(); ++n)
    if (edges_at[n].empty()) ends_.push_back({n, n});
  for (const auto& [a, b] : ends_) cones_.emplace_back(node(a), node(b));
  std::vector<Index> near;
  near_at_ = {0};
  for (Index c = 0; c < cones_.size(); ++c) {
    near.assign(1, c);
    for (const Index n : ends_[c]) {
      for (const Index e : edges_at[n]) {
        near.push_back(e);
        const std::vector<Index>& beyond = edges_at[other_end(graph, e, n)];
        near.insert(near.end(), beyond.begin(), beyond.end());
      }
    }
    sort_unique(near);
    near_.insert(near_.end(), near.begin(), near.end());
    near_at_.push_back(static_cast<Index>(near_.size()));
  }
}

BoxTree GraphCones::tree() const {
  std::vector<Vec3> low, high;
  for (const RoundCone& cone : cones_) {
    const Vec3 end = cone.origin + cone.axis;
    low.push_back((cone.origin.array() - cone.r0).min(end.array() - cone.r1));
    high.push_back((cone.origin.array() + cone.r0).max(end.array() + cone.r1));
  }
  return {low, high};
}

std::vector<GraphCones::Place> GraphCones::closest(const std::vector<Vec3>& points) const {
  const BoxTree boxes = tree();
  std::vector<Place> places(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    Place best{kNone, std::numeric_limits<double>::infinity(), 0};
    boxes.visit(points[i], best.distance, [&](Index c) {
      const auto [distance, t] = cones_[c].distance_to(points[i]);
      if (distance < best.distance || (distance == best.distance && c < best.cone)) best = {c, distance, t};
    });
    places[i] = best;
  });
  return places;
}

GraphCones::Place GraphCones::closest(const Vec3& point, Index from) const {
  const auto at = [&](Index c) {
    const auto [distance, t] = cones_[c].distance_to(point);
    return Place{c, distance, t};
  };
  Place best = at(from);
  for (Index last = kNone; last != best.cone;) {
    last = best.cone;
    for (Index i = near_at_[last]; i < near_at_[last + 1]; ++i) {
      const Place other = at(near_[i]);
      if (other.distance < best.distance) best = other;
    }
  }
  return best;
}

namespace {

/// Whether a node of an end chain sticks out of the other vessels by more than a bump would.
bool sticks_out(const Graph& graph, const GraphCones& cones, const BoxTree& boxes, const Chain& chain,
                const std::vector<bool>& removed) {
  const auto is_other = [&](Index c) {
    return c >= removed.size() ||
           (!removed[c] && std::find(chain.edges.begin(), chain.edges.end(), c) == chain.edges.end());
  };
  for (const Index n : chain.nodes) {
    const Node& node = graph.nodes[n];
    Place best{kNone, std::numeric_limits<double>::infinity(), 0};
    boxes.visit(node.position, best.distance, [&](Index c) {
      if (!is_other(c)) return;
      const auto [distance, t] = cones.cone(c).distance_to(node.position);
      if (distance < best.distance) best = {c, distance, t};
    });
    if (best.cone == kNone) return true;
    const double other = cones.radius_at(best);
    const double bump = std::max(kBump * other, std::min(kWideBump * other, kBumpWidths * node.radius));
    if (best.distance + node.radius > bump) return true;
  }
  return false;
}

}  // namespace

std::size_t prune_contained(Graph& graph) {
  const auto edges_at = incidence(graph);
  const GraphCones cones(graph);
  const BoxTree boxes = cones.tree();
  std::vector<bool> removed(graph.edges.size(), false);
  std::size_t count = 0;
  for (const Chain& chain : chains_of(graph)) {
    const bool first_free = edges_at[chain.nodes.front()].size() == 1;
    const bool last_free = edges_at[chain.nodes.back()].size() == 1;
    if (first_free == last_free) continue;
    if (graph.nodes[first_free ? chain.nodes.front() : chain.nodes.back()].fixed) continue;
    if (sticks_out(graph, cones, boxes, chain, removed)) continue;
    for (const Index e : chain.edges) removed[e] = true;
    ++count;
  }
  remove_with_nodes(graph, removed);
  return count;
}

namespace {

/// Moves the nodes; returns where the samples were before the last move.
template <class Samples>
std::vector<Place> move_nodes(Graph& graph, const Samples& samples, const FitRounds& rounds, const Progress& progress) {
  constexpr double kSettled = 2e-3;
  const std::vector<Node> first = graph.nodes;
  const auto edges_at = incidence(graph);
  std::vector<Place> places = GraphCones(graph).closest(samples.points);
  for (int round = 0; round < rounds.most; ++round) {
    report_progress(progress, "cones", static_cast<double>(round) / rounds.most);
    const GraphCones cones(graph);
    tbb::parallel_for(std::size_t{0}, samples.size(),
                      [&](std::size_t i) { places[i] = cones.closest(samples.points[i], places[i].cone); });
    Equations equations(graph.nodes.size());
    add_samples(equations, cones, samples, places);
    add_priors(equations, graph, edges_at, rounds);
    if (apply(graph, first, equations.solve()) < kSettled) break;
  }
  return places;
}

}  // namespace

double fit_cones(Graph& graph, const FitSamples& samples, const FitRounds& rounds, const Progress& progress) {
  const std::vector<Place> places = move_nodes(graph, samples, rounds, progress);
  return noise_of(samples, places, GraphCones(graph));
}

void fit_cones(Graph& graph, const FitVoxels& voxels, const FitRounds& rounds, const Progress& progress) {
  move_nodes(graph, voxels, rounds, progress);
}

}  // namespace vmesh::skeleton

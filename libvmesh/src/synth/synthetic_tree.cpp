#include "vmesh/synth/synthetic_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "vmesh/core/ascending.h"
#include "vmesh/core/error.h"

#include "synth/liver_region.h"
#include "synth/portable_math.h"
#include "synth/segment_distance.h"
#include "synth/sphere_grid.h"
#include "synth/tree_growth.h"

namespace vmesh {
namespace {

using growth::Branch;
using growth::RadiusLaw;
using portable::norm;

constexpr std::size_t kMaxVertices = 10'000'000;
constexpr double kVerticesPerEnd = 7.8;
constexpr double kLeafTaper = 0.9;  // end radius of a twig / start radius
constexpr double kGap = 1.04;       // between capsules' axes, in sums of radii

double polyline_length(const std::vector<Vec3>& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += norm(path[i] - path[i - 1]);
  return sum;
}

// Divides a path into `count` intervals of equal arc length; both ends stay.
std::vector<Vec3> resample(const std::vector<Vec3>& path, std::size_t count) {
  std::vector<Vec3> out{path.front()};
  const double piece = polyline_length(path) / static_cast<double>(count);
  double before = 0;
  std::size_t i = 1;
  for (std::size_t k = 1; k < count; ++k) {
    const double at = piece * static_cast<double>(k);
    double length = norm(path[i] - path[i - 1]);
    while (before + length < at && i + 1 < path.size()) {
      before += length;
      ++i;
      length = norm(path[i] - path[i - 1]);
    }
    out.push_back(path[i - 1] + (at - before) / length * (path[i] - path[i - 1]));
  }
  out.push_back(path.back());
  return out;
}

// Divides `budget` shares among owners of given sizes, at least `least` each, so that the largest size per share is
// small.
std::vector<std::size_t> deal(const std::vector<double>& sizes, std::size_t least, std::size_t budget) {
  std::vector<std::size_t> counts(sizes.size(), least);
  std::priority_queue<std::pair<double, std::int64_t>> queue;
  const auto piece = [&](std::size_t i) { return sizes[i] / static_cast<double>(counts[i]); };
  for (std::size_t i = 0; i < sizes.size(); ++i) queue.push({piece(i), -static_cast<std::int64_t>(i)});
  for (std::size_t dealt = least * sizes.size(); dealt < budget; ++dealt) {
    const auto i = static_cast<std::size_t>(-queue.top().second);
    queue.pop();
    ++counts[i];
    queue.push({piece(i), -static_cast<std::int64_t>(i)});
  }
  return counts;
}

// The grown branches, resampled to the requested number of nodes, with radii by Murray's law.
class Tree {
 public:
  Tree(std::vector<Branch> branches, RadiusLaw law) : branches_(std::move(branches)), law_(law) {}

  void place_nodes(std::size_t vertices) {
    update_radii();
    std::vector<double> sizes;
    for (const Branch& b : branches_) sizes.push_back(b.length / b.radius);
    const auto counts = deal(sizes, vertices > 2 * branches_.size() ? 2 : 1, vertices - 1);
    for (std::size_t b = 0; b < branches_.size(); ++b) branches_[b].path = resample(branches_[b].path, counts[b]);
  }

  // Numbers the nodes, trunk first, each branch followed by its subtrees, and gives them radii.
  void number_nodes() {
    update_radii();
    nodes_.clear();
    parents_.clear();
    branch_of_.clear();
    std::vector<std::pair<Index, Index>> stack{{0, kNone}};  // branch, node it starts from
    while (!stack.empty()) {
      const auto [b, start] = stack.back();
      stack.pop_back();
      append_branch(b, start);
      const auto end = static_cast<Index>(nodes_.size() - 1);
      if (branches_[b].is_leaf()) continue;
      auto [first, second] = branches_[b].children;
      if (branches_[first].weight > branches_[second].weight) std::swap(first, second);
      stack.push_back({first, end});
      stack.push_back({second, end});
    }
    measure_arcs();
  }

  std::size_t node_count() const { return nodes_.size(); }

  // Cuts off what comes too close to another vessel. Returns whether anything was cut.
  bool cut_contacts();

  // Adds nodes to the longest segments.
  void refine(std::size_t vertices);

  Centerline centerline() && {
    std::vector<CenterlineSegment> segments;
    for (Index n = 1; n < nodes_.size(); ++n) segments.push_back({parents_[n], n});
    return {std::move(nodes_), std::move(segments)};
  }

 private:
  void update_radii() {
    for (std::size_t i = branches_.size(); i-- > 0;) {  // children come after their parents
      Branch& b = branches_[i];
      if (!b.is_leaf()) b.weight = branches_[b.children[0]].weight + branches_[b.children[1]].weight;
      b.radius = law_(b.weight);
    }
  }

  double end_radius(const Branch& b) const {
    if (b.is_leaf()) return kLeafTaper * b.radius;
    const double r0 = branches_[b.children[0]].radius, r1 = branches_[b.children[1]].radius;
    return portable::cbrt(r0 * r0 * r0 + r1 * r1 * r1);
  }

  // The first node after a fork has the branch's full radius (Murray's law holds there), the last one its end radius.
  void append_branch(Index b, Index start) {
    const Branch& branch = branches_[b];
    const double end = end_radius(branch);
    const std::size_t last = branch.path.size() - 1;
    const double tapered = branch.length - norm(branch.path[1] - branch.path[0]);
    double along = 0;
    if (start == kNone) push_node(branch.path[0], branch.radius, kNone, b);
    for (std::size_t i = 1; i <= last; ++i) {
      if (i > 1) along += norm(branch.path[i] - branch.path[i - 1]);
      const double t = i == last ? 1 : along / tapered;
      const double radius = last == 1 && branch.is_leaf() ? branch.radius : branch.radius + t * (end - branch.radius);
      push_node(branch.path[i], radius, i == 1 ? start : static_cast<Index>(nodes_.size() - 1), b);
      if (i == 1 && start == kNone) parents_.back() = 0;
    }
  }

  void push_node(const Vec3& position, double radius, Index parent, Index branch) {
    nodes_.push_back({position, radius});
    parents_.push_back(parent);
    branch_of_.push_back(branch);
  }

  void measure_arcs() {
    arcs_.assign(nodes_.size(), 0);
    depths_.assign(nodes_.size(), 0);
    for (std::size_t n = 1; n < nodes_.size(); ++n) {
      arcs_[n] = arcs_[parents_[n]] + norm(nodes_[n].position - nodes_[parents_[n]].position);
      depths_[n] = depths_[parents_[n]] + 1;
    }
  }

  // Segments are named by their far node.
  double segment_radius(Index n) const { return std::max(nodes_[n].radius, nodes_[parents_[n]].radius); }

  // Path length between the near ends of two segments, as far as it is below `bound`.
  bool near_along_tree(Index a, Index b, double bound) const;
  bool in_contact(Index a, Index b) const;
  void cut_before(Index node);
  void remove_children(Branch& branch);

  std::vector<Branch> branches_;
  RadiusLaw law_;
  std::vector<CenterlineNode> nodes_;
  std::vector<Index> parents_, branch_of_;
  std::vector<double> arcs_;
  std::vector<std::uint32_t> depths_;
};

bool Tree::near_along_tree(Index a, Index b, double bound) const {
  // The lowest common ancestor of the far nodes; it is below the near node of one only if that is the other's
  // ancestor, and then the path leads from the upper segment's far node to the lower one's near node.
  Index x = a, y = b;
  while (x != y) {
    Index& deeper = depths_[x] >= depths_[y] ? x : y;
    deeper = parents_[deeper];
    if (std::min(arcs_[a], arcs_[b]) - std::min(arcs_[x], arcs_[y]) > 2 * bound && x != y) return false;
  }
  const double upper_a = x == a ? arcs_[a] : arcs_[parents_[a]];
  const double upper_b = x == b ? arcs_[b] : arcs_[parents_[b]];
  return upper_a + upper_b - 2 * arcs_[x] <= bound;
}

bool Tree::in_contact(Index a, Index b) const {
  const double reach = segment_radius(a) + segment_radius(b);
  const Index pa = parents_[a], pb = parents_[b];
  const double distance =
      segment_distance(nodes_[pa].position, nodes_[a].position, nodes_[pb].position, nodes_[b].position);
  return distance < kGap * reach && !near_along_tree(a, b, 2 * reach);
}

bool Tree::cut_contacts() {
  const auto reach_of = [&](Index n) {
    return kGap * segment_radius(n) + 0.5 * norm(nodes_[n].position - nodes_[parents_[n]].position);
  };
  double largest = 0;
  for (Index n = 1; n < nodes_.size(); ++n) largest = std::max(largest, reach_of(n));
  SphereGrid grid(largest);
  const auto middle = [&](Index n) { return Vec3(0.5 * (nodes_[n].position + nodes_[parents_[n]].position)); };
  for (Index n = 1; n < nodes_.size(); ++n) grid.push(middle(n), reach_of(n));  // item n - 1
  std::vector<Index> cuts;
  for (Index n = 1; n < nodes_.size(); ++n) {
    grid.visit(middle(n), reach_of(n), false, [&](Index item) {
      const Index m = item + 1;
      if (m != n && in_contact(n, m)) {
        const bool n_goes =
            std::pair(branches_[branch_of_[n]].weight, m) < std::pair(branches_[branch_of_[m]].weight, n);
        cuts.push_back(n_goes ? n : m);
      }
      return true;
    });
  }
  sort_unique(cuts);
  // In tree order: everything below a cut is removed with it, so that its own cuts find nothing.
  for (const Index n : cuts) cut_before(n);
  return !cuts.empty();
}

// Ends the branch of `node` before it. If nothing would remain of the branch, its parent ends at the fork: its sibling
// alone would leave a kink there.
void Tree::cut_before(Index node) {
  Index b = branch_of_[node];
  const Vec3 position = nodes_[node].position;
  auto& path = branches_[b].path;
  const auto at = std::find(path.begin() + 1, path.end(), position);
  if (at == path.end()) return;  // gone already
  if (at == path.begin() + 1) {
    if (b == 0) return;
    b = branches_[b].parent;
    remove_children(branches_[b]);
    return;
  }
  path.erase(at, path.end());
  branches_[b].length = polyline_length(path);
  remove_children(branches_[b]);
}

void Tree::remove_children(Branch& branch) {
  if (branch.is_leaf()) return;
  double lightest = branch.weight;
  std::vector<Index> stack(branch.children.begin(), branch.children.end());
  branch.children = {kNone, kNone};
  while (!stack.empty()) {
    Branch& gone = branches_[stack.back()];
    stack.pop_back();
    lightest = std::min(lightest, gone.weight);
    gone.path.resize(1);
    if (!gone.is_leaf()) stack.insert(stack.end(), gone.children.begin(), gone.children.end());
    gone.children = {kNone, kNone};
  }
  branch.weight = lightest;
}

void Tree::refine(std::size_t vertices) {
  if (nodes_.size() >= vertices) return;
  std::vector<double> sizes;
  for (Index n = 1; n < nodes_.size(); ++n) {
    sizes.push_back(norm(nodes_[n].position - nodes_[parents_[n]].position) / segment_radius(n));
  }
  const auto counts = deal(sizes, 1, vertices - 1);
  std::size_t next = 0;
  std::vector<Index> order;  // branches in the order of their nodes
  for (Index n = 1; n < nodes_.size(); ++n) {
    if (order.empty() || order.back() != branch_of_[n]) order.push_back(branch_of_[n]);
  }
  for (const Index b : order) {
    const std::vector<Vec3> old = std::exchange(branches_[b].path, {});
    branches_[b].path.push_back(old[0]);
    for (std::size_t i = 1; i < old.size(); ++i, ++next) {
      const auto pieces = counts[next];
      for (std::size_t k = 1; k < pieces; ++k) {
        const double t = static_cast<double>(k) / static_cast<double>(pieces);
        branches_[b].path.push_back((1 - t) * old[i - 1] + t * old[i]);
      }
      branches_[b].path.push_back(old[i]);
    }
  }
}

}  // namespace

Centerline synthetic_tree(const SyntheticTreeOptions& options) {
  if (options.vertices < 2 || options.vertices > kMaxVertices) {
    throw InvalidInput("a synthetic tree has 2 to " + std::to_string(kMaxVertices) + " vertices, not " +
                       std::to_string(options.vertices));
  }
  const auto ends =
      std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(options.vertices) / kVerticesPerEnd + 0.5));
  RadiusLaw law = growth::radius_law(ends);
  std::vector<Branch> branches = growth::grow(ends, options.seed, law.total);
  Tree tree(std::move(branches), law);
  tree.place_nodes(options.vertices);
  tree.number_nodes();
  while (tree.cut_contacts() || tree.node_count() < options.vertices) {
    tree.number_nodes();
    tree.refine(options.vertices);
    tree.number_nodes();
  }
  return std::move(tree).centerline();
}

bool in_synthetic_tree_region(const Vec3& p) { return liver::region(p) < 0; }

}  // namespace vmesh

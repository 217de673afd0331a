#include "quality/hausdorff_search.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

constexpr Index kFacesPerBlock = 32;
constexpr std::size_t kPromisingBlocks = 16;
constexpr std::size_t kPromisingFaces = 64;
constexpr int kCutsAtFaces = 16;  // of a piece; then its longest edge is halved, which is sure to come to an end
constexpr std::size_t kReportEvery = 4096;  // points

// Where to cut a piece: the edge from corner `first` to the next one, and the place on it.
struct Cut {
  int first = 0;
  double share = 0.5;
};

// Where the closest face of one corner takes over from that of the next, if all distances were linear: among coplanar
// faces that is where one ends and the other begins, and the parts lie on one face each. The middle where corners share
// their closest face.
double change_of_face(const MeasuredPoint& a, const MeasuredPoint& b, const TriangleTree& other) {
  constexpr double kAtEnds = 1.0 / 16;
  if (a.nearest.face == b.nearest.face) return 0.5;
  const double beyond_a = std::sqrt(other.frame(b.nearest.face).squared_distance(a.position)) - a.nearest.distance;
  const double beyond_b = std::sqrt(other.frame(a.nearest.face).squared_distance(b.position)) - b.nearest.distance;
  const double sum = beyond_a + beyond_b;
  return sum > 0 ? std::clamp(beyond_a / sum, kAtEnds, 1 - kAtEnds) : 0.5;
}

Cut longest_edge(const Piece& piece) {
  double length[3];
  for (int i = 0; i < 3; ++i) length[i] = (piece[i].position - piece[(i + 1) % 3].position).squaredNorm();
  return {static_cast<int>(std::max_element(length, length + 3) - length), 0.5};
}

Cut choose_cut(const Piece& piece, const TriangleTree& other) {
  Cut cut = longest_edge(piece);
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    const MeasuredPoint &a = piece[i], &b = piece[(i + 1) % 3];
    const double length = (a.position - b.position).squaredNorm();
    if (a.nearest.face == b.nearest.face || length <= longest) continue;
    longest = length;
    cut = {i, change_of_face(a, b, other)};
  }
  return cut;
}

double largest_distance(const Piece& piece) {
  return std::max({piece[0].nearest.distance, piece[1].nearest.distance, piece[2].nearest.distance});
}

// Moves the `count` items of the highest rank to the front; the others keep their order.
template <class Ranked>
void bring_forward(std::vector<Ranked>& items, std::size_t count) {
  if (items.size() <= count) return;
  const auto higher = [](const Ranked& x, const Ranked& y) {
    return std::tie(y.rank, x.item) < std::tie(x.rank, y.item);
  };
  std::vector<Ranked> ordered = items;
  const auto first_left = ordered.begin() + static_cast<std::ptrdiff_t>(count);
  std::nth_element(ordered.begin(), first_left, ordered.end(), higher);
  const auto others =
      std::stable_partition(items.begin(), items.end(), [&](const Ranked& item) { return higher(item, *first_left); });
  std::sort(items.begin(), others, higher);
}

}  // namespace

HausdorffSearch::HausdorffSearch(const TriMesh& from, const TriangleTree& tree, const Goal& goal,
                                 const Progress& progress)
    : from_(from), tree_(tree), goal_(goal), progress_(progress), vertices_(from.vertices.size()), lower_(goal.start) {}

void HausdorffSearch::run() {
  look_at_blocks();
  // The most promising faces raise the lower bound; the others then go by in the order of the curve, so that neighbours
  // find the same boxes in the cache.
  bring_forward(unsettled_, kPromisingFaces);
  for (std::size_t i = 0; i < unsettled_.size() && !done(); ++i) {
    done_fraction_ = 0.5 + 0.5 * static_cast<double>(i) / static_cast<double>(unsettled_.size());
    if (!settle(unsettled_[i].rank)) divide(whole_face(unsettled_[i].item), unsettled_[i].item);
  }
}

// Whether a piece with this upper bound needs no further look.
bool HausdorffSearch::settle(double bound) {
  if (bound > good_enough()) return false;
  upper_ = std::max(upper_, bound);
  return true;
}

MeasuredPoint HausdorffSearch::measure(const Vec3& p, Index near, Index face) {
  if (++measured_ % kReportEvery == 0) report_progress(progress_, "distance", done_fraction_);
  const MeasuredPoint point{p, tree_.nearest(p, near)};
  last_found_ = point.nearest.face;
  if (point.nearest.distance > lower_) {
    lower_ = point.nearest.distance;
    farthest_ = point;
    farthest_face_ = face;
  }
  return point;
}

const NearestFace& HausdorffSearch::measure_vertex(Index v, Index face) {
  if (vertices_[v].face == kNone) vertices_[v] = measure(from_.vertices[v], last_found_, face).nearest;
  return vertices_[v];
}

Piece HausdorffSearch::whole_face(Index face) const {
  Piece piece;
  for (int i = 0; i < 3; ++i) {
    const Index v = from_.faces[face][i];
    piece[i] = {from_.vertices[v], vertices_[v]};
  }
  return piece;
}

// Settles the blocks that cannot hold a larger distance, and the faces of the others as far as their corners do.
void HausdorffSearch::look_at_blocks() {
  blocks_ = cut_into_blocks(from_, measure_extent(from_), kFacesPerBlock);
  std::vector<Ranked> ranked;
  std::vector<NearestFace> nearest;
  for (const FaceBlock& block : blocks_.blocks) {
    nearest.push_back(tree_.nearest(block.center, nearest.empty() ? kNone : nearest.back().face));
    ranked.push_back({nearest.back().distance, static_cast<Index>(ranked.size())});
  }
  bring_forward(ranked, kPromisingBlocks);
  for (std::size_t i = 0; i < ranked.size() && !done(); ++i) {
    done_fraction_ = 0.5 * static_cast<double>(i) / static_cast<double>(ranked.size());
    const FaceBlock& block = blocks_.blocks[ranked[i].item];
    if (!settle(ranked[i].rank + block.radius)) look_at_faces(block, nearest[ranked[i].item].face);
  }
}

void HausdorffSearch::look_at_faces(const FaceBlock& block, Index near) {
  last_found_ = near;
  for (Index i = block.first; i < block.last; ++i) {
    const Index face = blocks_.order[i];
    for (const Index v : from_.faces[face]) measure_vertex(v, face);
    const double bound = upper_bound(whole_face(face), tree_, good_enough());
    if (!settle(bound)) unsettled_.push_back({bound, face});
  }
}

void HausdorffSearch::divide(const Piece& piece, Index face) {
  struct OpenPiece {
    Piece piece;
    int cuts;
  };
  std::vector<OpenPiece> open = {{piece, 0}};
  while (!open.empty() && !done()) {
    const auto [whole, cuts] = open.back();
    open.pop_back();
    if (settle(upper_bound(whole, tree_, good_enough()))) continue;
    const Cut cut = cuts < kCutsAtFaces ? choose_cut(whole, tree_) : longest_edge(whole);
    const MeasuredPoint &a = whole[cut.first], &b = whole[(cut.first + 1) % 3];
    const MeasuredPoint& closer = a.nearest.distance < b.nearest.distance ? a : b;
    const MeasuredPoint middle = measure(a.position + cut.share * (b.position - a.position), closer.nearest.face, face);
    Piece parts[2] = {whole, whole};
    parts[0][cut.first] = parts[1][(cut.first + 1) % 3] = middle;
    const bool second_farther = largest_distance(parts[1]) > largest_distance(parts[0]);
    open.push_back({parts[second_farther ? 0 : 1], cuts + 1});
    open.push_back({parts[second_farther ? 1 : 0], cuts + 1});
  }
}

}  // namespace vmesh

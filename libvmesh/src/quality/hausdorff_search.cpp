#include "quality/hausdorff_search.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

constexpr Index kFacesPerBlock = 32;
constexpr std::size_t kPromisingBlocks = 16;
constexpr std::size_t kPromisingFaces = 64;
// Pieces are first halved, which is cheaper where meshes are apart; then cut at the edges of the other mesh, without
// which coinciding meshes would never be settled; finally halved, which is certain to terminate.
constexpr int kFirstCutAtEdge = 5;
constexpr int kLastCutAtEdge = 24;
constexpr double kLeastDepth = 0.25;        // of a part cut off at an edge, in tolerances
constexpr std::size_t kReportEvery = 4096;  // points

PieceCut halve_longest_edge(const Piece& piece) {
  double length[3];
  for (int i = 0; i < 3; ++i) length[i] = (piece[i].position - piece[(i + 1) % 3].position).squaredNorm();
  return {static_cast<int>(std::max_element(length, length + 3) - length), 0.5, 1};
}

// Cuts along the edge of `face` that divides the piece best: parts above a single face have their largest distance from
// it at a corner. nullopt if no part would be deeper than `least`.
std::optional<PieceCut> cut_at_edge(const Piece& piece, const TriangleFrame& face, double least) {
  std::array<double, 3> inside[3];
  for (int i = 0; i < 3; ++i) inside[i] = face.distances_from_edges(piece[i].position);
  int edge = -1;
  for (int e = 0; e < 3; ++e) {
    const auto [low, high] = std::minmax({inside[0][e], inside[1][e], inside[2][e]});
    const double depth = std::min(-low, high);
    if (depth > least) edge = e, least = depth;
  }
  if (edge < 0) return std::nullopt;
  // The corner that is alone on its side.
  int apex = 0;
  for (int i = 1; i < 3; ++i) {
    const bool positive = inside[i][edge] > 0;
    if (positive != (inside[(i + 1) % 3][edge] > 0) && positive != (inside[(i + 2) % 3][edge] > 0)) apex = i;
  }
  const auto share = [&](int other) {
    return std::clamp(inside[apex][edge] / (inside[apex][edge] - inside[other][edge]), 0.0, 1.0);
  };
  return PieceCut{apex, share((apex + 1) % 3), share((apex + 2) % 3)};
}

Vec3 middle_of(const Piece& piece) { return (piece[0].position + piece[1].position + piece[2].position) / 3; }

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
  // The most promising faces raise the lower bound; the others follow in the order of the curve, so that neighbours
  // find the same boxes in the cache.
  bring_forward(unsettled_, kPromisingFaces);
  for (std::size_t i = 0; i < unsettled_.size() && !done(); ++i) {
    done_fraction_ = 0.5 + 0.5 * static_cast<double>(i) / static_cast<double>(unsettled_.size());
    if (!settle(unsettled_[i].rank)) divide(unsettled_[i].item);
  }
}

// Whether a piece with this upper bound needs no further search.
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

// Settles the blocks that cannot contain a larger distance, and those faces of the others that their corners settle.
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

// Divides a face until every part is settled.
void HausdorffSearch::divide(Index face) {
  std::vector<OpenPiece> open = {{whole_face(face), 0}};
  while (!open.empty() && !done()) {
    const auto [piece, cuts] = open.back();
    open.pop_back();
    if (settle(upper_bound(piece, tree_, good_enough()))) continue;
    std::optional<PieceCut> cut;
    const bool touching = largest_distance(piece) <= goal_.tolerance;
    if ((touching || cuts >= kFirstCutAtEdge) && cuts < kLastCutAtEdge) {
      const Index below = measure(middle_of(piece), piece[0].nearest.face, face).nearest.face;
      if (settle(single_face_bound(piece, tree_.frame(below)))) continue;
      cut = cut_at_edge(piece, tree_.frame(below), kLeastDepth * goal_.tolerance);
    }
    push_parts(piece, cut ? *cut : halve_longest_edge(piece), cuts + 1, face, open);
  }
}

// Appends the two or three triangles that result from a cut, the one with the largest distance last.
void HausdorffSearch::push_parts(const Piece& piece, const PieceCut& cut, int cuts, Index face,
                                 std::vector<OpenPiece>& open) {
  const MeasuredPoint &a = piece[cut.apex], &b = piece[(cut.apex + 1) % 3], &c = piece[(cut.apex + 2) % 3];
  const MeasuredPoint ab = measure_between(a, b, cut.next, face), ac = measure_between(a, c, cut.after_next, face);
  const auto first = static_cast<std::ptrdiff_t>(open.size());
  open.push_back({{a, ab, ac}, cuts});
  if (cut.next < 1) open.push_back({{ab, b, c}, cuts});
  if (cut.after_next < 1) open.push_back({{ab, c, ac}, cuts});
  std::sort(open.begin() + first, open.end(), [](const OpenPiece& x, const OpenPiece& y) {
    return largest_distance(x.piece) < largest_distance(y.piece);
  });
}

MeasuredPoint HausdorffSearch::measure_between(const MeasuredPoint& a, const MeasuredPoint& b, double share,
                                               Index face) {
  if (share == 1) return b;
  const MeasuredPoint& closer = a.nearest.distance < b.nearest.distance ? a : b;
  return measure(a.position + share * (b.position - a.position), closer.nearest.face, face);
}

}  // namespace vmesh

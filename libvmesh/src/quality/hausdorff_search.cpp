#include "quality/hausdorff_search.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

constexpr Index kFacesPerBlock = 32;
constexpr Index kReportEvery = 256;  // blocks or faces

int longest_edge(const Piece& piece) {
  double length[3];
  for (int i = 0; i < 3; ++i) length[i] = (piece[i].position - piece[(i + 1) % 3].position).squaredNorm();
  return static_cast<int>(std::max_element(length, length + 3) - length);
}

double largest_distance(const Piece& piece) {
  return std::max({piece[0].nearest.distance, piece[1].nearest.distance, piece[2].nearest.distance});
}

}  // namespace

HausdorffSearch::HausdorffSearch(const TriMesh& from, const TriMesh& to, const TriangleTree& tree, const Goal& goal)
    : from_(from), to_(to), tree_(tree), goal_(goal), vertices_(from.vertices.size()), lower_(goal.start) {}

void HausdorffSearch::run(const Progress& progress) {
  const std::vector<RankedFace> unsettled = keep_unsettled(measure_blocks(progress));
  for (std::size_t i = 0; i < unsettled.size() && !done(); ++i) {
    if (i % kReportEvery == 0) {
      report_progress(progress, "distance", static_cast<double>(i) / static_cast<double>(unsettled.size()));
    }
    if (settle(unsettled[i].bound)) continue;
    const Piece piece = whole_face(unsettled[i].face);
    if (!sandwiched(piece)) bisect(piece, unsettled[i].face);
  }
}

// Whether a piece with this upper bound needs no further look.
bool HausdorffSearch::settle(double bound) {
  if (bound > good_enough()) return false;
  upper_ = std::max(upper_, bound);
  return true;
}

MeasuredPoint HausdorffSearch::measure(const Vec3& p, Index near, Index face) {
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

// Measures the corners of all faces but those in blocks that cannot hold a larger distance; returns the former.
std::vector<Index> HausdorffSearch::measure_blocks(const Progress& progress) {
  blocks_ = cut_into_blocks(from_, measure_extent(from_), kFacesPerBlock);
  std::vector<RankedFace> ranked;
  ranked.reserve(blocks_.blocks.size());
  Index near = kNone;
  for (Index b = 0; b < blocks_.blocks.size(); ++b) {
    const FaceBlock& block = blocks_.blocks[b];
    const NearestFace nearest = tree_.nearest(block.center, near);
    near = nearest.face;
    ranked.push_back({nearest.distance + block.radius, b});
  }
  std::sort(ranked.begin(), ranked.end(), [](const RankedFace& x, const RankedFace& y) {
    return std::tie(y.bound, x.face) < std::tie(x.bound, y.face);
  });
  std::vector<Index> faces;
  for (std::size_t i = 0; i < ranked.size() && !done(); ++i) {
    if (i % kReportEvery == 0) report_progress(progress, "corners", static_cast<double>(i) / static_cast<double>(ranked.size()));
    if (!settle(ranked[i].bound)) measure_block(blocks_.blocks[ranked[i].face], faces);
  }
  return faces;
}

void HausdorffSearch::measure_block(const FaceBlock& block, std::vector<Index>& faces) {
  for (Index i = block.first; i < block.last; ++i) {
    const Index face = blocks_.order[i];
    for (const Index v : from_.faces[face]) measure_vertex(v, face);
    faces.push_back(face);
  }
}

// The faces whose corners do not settle them, those with the largest bounds first.
std::vector<HausdorffSearch::RankedFace> HausdorffSearch::keep_unsettled(const std::vector<Index>& faces) {
  std::vector<RankedFace> unsettled;
  for (const Index face : faces) {
    const double bound = upper_bound(whole_face(face), tree_, good_enough());
    if (!settle(bound)) unsettled.push_back({bound, face});
  }
  std::sort(unsettled.begin(), unsettled.end(), [](const RankedFace& x, const RankedFace& y) {
    return std::tie(y.bound, x.face) < std::tie(x.bound, y.face);
  });
  return unsettled;
}

bool HausdorffSearch::sandwiched(const Piece& piece) {
  if (!sandwich_) sandwich_.emplace(to_, tree_);
  if (!sandwich_->available()) return false;
  const double s = good_enough();
  return sandwich_->within({piece[0].position, piece[1].position, piece[2].position}, s) && settle(s);
}

void HausdorffSearch::bisect(const Piece& piece, Index face) {
  std::vector<Piece> open = {piece};
  while (!open.empty() && !done()) {
    const Piece whole = open.back();
    open.pop_back();
    if (settle(upper_bound(whole, tree_, good_enough()))) continue;
    const int a = longest_edge(whole), b = (a + 1) % 3;
    const MeasuredPoint& closer = whole[a].nearest.distance < whole[b].nearest.distance ? whole[a] : whole[b];
    const MeasuredPoint middle =
        measure(0.5 * (whole[a].position + whole[b].position), closer.nearest.face, face);
    Piece halves[2] = {whole, whole};
    halves[0][a] = halves[1][b] = middle;
    const bool second_farther = largest_distance(halves[1]) > largest_distance(halves[0]);
    open.push_back(halves[second_farther ? 0 : 1]);
    open.push_back(halves[second_farther ? 1 : 0]);
  }
}

}  // namespace vmesh

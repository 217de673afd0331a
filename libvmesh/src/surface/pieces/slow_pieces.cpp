#include "surface/pieces/slow_pieces.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace vmesh {
namespace {

constexpr double kSlow = 10;  // times the median

// Those of its seams count by half, they belong to two pieces.
double time_of_a_vertex(const PieceWork& work) {
  const double vertices = static_cast<double>(work.vertices) + 0.5 * static_cast<double>(work.seam_vertices);
  return work.seconds / std::max(1.0, vertices);
}

std::string describe(const PieceTry& made) {
  if (made.fault) return std::to_string(made.faults) + " times " + std::string(to_string(*made.fault));
  if (made.faults > 0) return "a junction's surface hung between " + std::to_string(made.faults) + " vessels";
  char text[64];
  std::snprintf(text, sizeof text, "a triangle of skewness %.3f", made.worst_skewness);
  return text;
}

std::string reason_of(const PieceSurface& piece) {
  const std::vector<PieceTry>& failed = piece.work.failed;
  if (failed.empty()) {
    return "made at the first try: " + std::to_string(piece.work.vertices) + " vertices, " +
           std::to_string(piece.junctions) + " junctions";
  }
  std::string text = "after tries that ended with";
  for (std::size_t i = 0; i < failed.size(); ++i) text += (i > 0 ? ", then " : " ") + describe(failed[i]);
  return text;
}

Vec3 position_of(const PieceWork& work, const PiecePlan& plan, const Centerline& centerline) {
  if (plan.nodes.empty()) return work.position;
  return centerline
      .node(*std::max_element(plan.nodes.begin(), plan.nodes.end(),
                              [&](Index a, Index b) { return centerline.node(a).radius < centerline.node(b).radius; }))
      .position;
}

}  // namespace

std::vector<SlowPiece> slow_pieces(const std::vector<PieceSurface>& pieces, const std::vector<PiecePlan>& plans,
                                   const Centerline& centerline) {
  std::vector<SlowPiece> slow;
  if (pieces.empty()) return slow;
  std::vector<double> times;
  for (const PieceSurface& piece : pieces) times.push_back(time_of_a_vertex(piece.work));
  std::vector<double> sorted = times;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (times[p] <= kSlow * *middle) continue;
    const PieceWork& work = pieces[p].work;
    slow.push_back({position_of(work, plans[p], centerline), work.vertices, work.seconds, times[p] / *middle,
                    reason_of(pieces[p])});
  }
  std::stable_sort(slow.begin(), slow.end(),
                   [](const SlowPiece& a, const SlowPiece& b) { return a.seconds > b.seconds; });
  return slow;
}

}  // namespace vmesh

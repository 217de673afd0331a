#include "volume/divided_centerline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vmesh {
namespace {

constexpr double kLeaf = 0.5;  // smaller radii; safe 0.35 to 0.7
// Ratio of the larger radius to the smaller beyond which leaves do not become shorter; safe 5.6 to 11.
constexpr double kSteepestFactor = 8;
constexpr Index kMostLeaves = 4096;  // per segment; idle 2867 to 5734

}  // namespace

DividedCenterline undivided(const Centerline& centerline) {
  std::vector<SegmentPiece> pieces;
  for (Index s = 0; s < centerline.segments().size(); ++s) pieces.push_back({s, 0, 1});
  return {centerline, std::move(pieces)};
}

DividedCenterline composed(const DividedCenterline& outer, DividedCenterline inner) {
  for (SegmentPiece& piece : inner.pieces) {
    const SegmentPiece& whole = outer.pieces[piece.segment];
    // lerp: exact at the ends.
    piece = {whole.segment, std::lerp(whole.t_first, whole.t_last, piece.t_first),
             std::lerp(whole.t_first, whole.t_last, piece.t_last)};
  }
  return inner;
}

Index leaf_count_of(const Centerline& centerline, Index segment) {
  const auto [smaller, larger] = std::minmax({centerline.radius_at(segment, 0), centerline.radius_at(segment, 1)});
  const double count = std::ceil(centerline.length(segment) / (kLeaf * std::max(smaller, larger / kSteepestFactor)));
  return static_cast<Index>(std::clamp(count, 1.0, double{kMostLeaves}));
}

}  // namespace vmesh

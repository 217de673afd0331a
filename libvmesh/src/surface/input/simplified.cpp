#include <algorithm>

#include "vmesh/core/error.h"
#include "vmesh/surface/generate.h"

#include "surface/remesh/sweep_state.h"

namespace vmesh {
namespace {

constexpr double kMostOfLimit = 0.1;
// Vertices around a vessel that count at least: the surface of three comes near the axis, and what is left out of that
// should not matter there.
constexpr int kLeastAround = 6;
// Of the limit, for the surface around the simplified vessels. Derived: a limit in radii is taken of theirs, which are
// larger by a hundredth at most.
constexpr double kLeftOfLimit = 0.88;

// An end of the original, by its number there.
Index end_in(const SimplifiedCenterline& simplified, Index node) {
  const auto it = std::lower_bound(simplified.node.begin(), simplified.node.end(), node);
  const auto number = static_cast<Index>(it - simplified.node.begin());
  if (it == simplified.node.end() || *it != node || simplified.centerline.degree(number) != 1)
    throw InvalidInput("node " + std::to_string(node) + " cannot be left open: it is not an end of the centerline");
  return number;
}

}  // namespace

SimplifiedCenterline simplify_for_growth(const Centerline& centerline, const GenerateOptions& options) {
  const double edge = edge_length_per_radius(std::max(kLeastAround, options.around));
  const double cut_off = edge * edge / 16;  // balanced: half of it is outside
  return simplify(centerline, [&](double radius) {
    const double tolerance = options.simplification * cut_off * radius;
    return options.max_error.is_set() ? std::min(tolerance, kMostOfLimit * options.max_error.at(radius)) : tolerance;
  });
}

GenerateOptions after_simplification(const GenerateOptions& options, const SimplifiedCenterline& simplified) {
  GenerateOptions result = options;
  result.simplification = 0;
  if (!simplified.is_simpler()) return result;
  for (Index& n : result.open_ends.nodes) n = end_in(simplified, n);
  result.max_error.mm *= kLeftOfLimit;
  result.max_error.relative *= kLeftOfLimit;
  return result;
}

void refer_to_original(const SimplifiedCenterline& simplified, GenerateResult& result) {
  for (CenterlineBinding& binding : result.binding) {
    const auto [segment, t] = simplified.original(binding.segment, binding.t);
    binding = {segment, t};
  }
  for (Opening& opening : result.openings) opening.node = simplified.node[opening.node];
  for (GrowthSimplification& note : result.growth.simplifications) {
    for (Index& n : note.nodes) n = simplified.node[n];
    std::vector<Index> segments;
    for (const Index s : note.segments) {
      for (Index p = simplified.offsets[s]; p < simplified.offsets[s + 1]; ++p)
        segments.push_back(simplified.pieces[p].segment);
    }
    std::sort(segments.begin(), segments.end());
    note.segments = std::move(segments);
  }
  for (Defect& defect : result.defects) {
    if (defect.segment != kNone) defect.segment = simplified.original(defect.segment, 0.5).segment;
    if (defect.node != kNone) defect.node = simplified.node[defect.node];
  }
  result.simplification = {simplified.pieces.size() - simplified.centerline.segments().size(), simplified.max_deviation,
                           simplified.max_deviation_relative};
}

}  // namespace vmesh

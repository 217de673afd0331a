#include <algorithm>

#include "vmesh/core/error.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/remesh/sweep_state.h"

namespace vmesh {
namespace {

constexpr double kMostOfLimit = 0.1;  // idle 0.07 to 0.14
// Vertices around a vessel that count at least: the surface of three comes near the axis, and what is left out of that
// should not matter there.
constexpr int kLeastAround = 6;  // safe 4 to 8
// Of the limit, for the surface around the simplified vessels. Derived: a limit in radii is taken of theirs, which are
// larger by a hundredth at most.
constexpr double kLeftOfLimit = 0.88;  // idle 0.62 to 1.2

// An end of the original, by its number there.
Index end_in(const SimplifiedCenterline& simplified, Index node) {
  const auto it = std::lower_bound(simplified.node.begin(), simplified.node.end(), node);
  const auto number = static_cast<Index>(it - simplified.node.begin());
  if (it == simplified.node.end() || *it != node || simplified.centerline.degree(number) != 1)
    throw InvalidInput("node " + std::to_string(node) + " cannot be left open: it is not an end of the centerline");
  return number;
}

// At cones where the blend is smaller than elsewhere. By how much, spheres along the segments decide: others would do
// if nodes were left out, and the boundary would change by more than the tolerance.
std::vector<char> nodes_less_rounded(const Centerline& centerline, double blend) {
  std::vector<char> result(centerline.nodes().size(), 0);
  const VesselField field(centerline, blend);
  for (Index c = 0; c < field.cone_count(); ++c) {
    if (field.rounding_at(c, 0) < 1 || field.rounding_at(c, 1) < 1)
      result[field.first_node(c)] = result[field.last_node(c)] = 1;
  }
  return result;
}

}  // namespace

SimplifiedCenterline simplify_for_growth(const Centerline& centerline, const GenerateOptions& options) {
  if (options.deformable) return simplify(centerline, [](Index) { return -1.0; });
  const double edge = edge_length_per_radius(std::max(kLeastAround, options.around));
  const double cut_off = edge * edge / 16;  // balanced: half of it is outside
  const auto tolerance = [&](Index node) { return options.simplification * cut_off * centerline.node(node).radius; };
  if (!options.max_error.is_set()) return simplify(centerline, tolerance);
  const std::vector<char> less_rounded = nodes_less_rounded(centerline, options.blend);
  return simplify(centerline, [&](Index node) {
    if (less_rounded[node]) return -1.0;
    return std::min(tolerance(node), kMostOfLimit * options.max_error.at(centerline.node(node).radius));
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

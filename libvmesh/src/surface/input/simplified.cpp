#include <algorithm>

#include "vmesh/core/error.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/remesh/edge_lengths.h"

namespace vmesh {
namespace {

constexpr double kMostOfLimit = 0.1;  // share of the error limit that simplification may use; idle 0.07 to 0.14
// Least number of vertices around that the tolerance assumes: a surface with three comes so near the axis that its own
// cut-off would be no measure.
constexpr int kLeastAround = 6;  // safe 4 to 8
// Share of the limit left for the surface around the simplified vessels. Derived: 1 - kMostOfLimit, less a margin
// because a limit in radii refers to theirs, which are at most a hundredth larger.
constexpr double kLeftOfLimit = 0.88;  // idle 0.62 to 1.2

// The number of an end of the original in the simplified centerline.
Index end_in(const SimplifiedCenterline& simplified, Index node) {
  const auto it = std::lower_bound(simplified.node.begin(), simplified.node.end(), node);
  const auto number = static_cast<Index>(it - simplified.node.begin());
  if (it == simplified.node.end() || *it != node || simplified.centerline.degree(number) != 1)
    throw InvalidInput("node " + std::to_string(node) + " cannot be left open: it is not an end of the centerline");
  return number;
}

// Marks nodes of cones whose blend is reduced. By how much is determined from spheres along the segments; leaving out
// nodes would change the spheres, and the boundary by more than the tolerance.
std::vector<char> nodes_less_rounded(const Centerline& centerline, double blend) {
  std::vector<char> result(centerline.nodes().size(), 0);
  const VesselField field(centerline, blend);
  for (Index c = 0; c < field.relations().cone_count(); ++c) {
    if (field.relations().rounding_at(c, 0) < 1 || field.relations().rounding_at(c, 1) < 1)
      result[field.relations().first_node(c)] = result[field.relations().last_node(c)] = 1;
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

#include "surface/input/size_check.h"

#include <algorithm>
#include <sstream>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"

#include "surface/finish/optimize.h"
#include "surface/input/scale_check.h"

namespace vmesh {
namespace {

void check_options(const GenerateOptions& o) {
  if (!(o.beta >= 0 && o.beta <= 1)) throw InvalidInput("beta must be in [0, 1]");
  if (!(o.around >= 3 && o.around <= 200)) throw InvalidInput("around must be in [3, 200]");
  if (!(o.ring_spacing >= kLeastRingSpacing && o.ring_spacing <= kMostRingSpacing))
    throw InvalidInput("ring_spacing must be in [0.8, 1.25]");
  if (!(o.max_center_distance > 0)) throw InvalidInput("max_center_distance must be > 0");
  if (!(o.simplification >= 0 && o.simplification <= 1)) throw InvalidInput("simplification must be in [0, 1]");
  if (!(o.elongation >= 1 && o.elongation <= kMostElongation))
    throw InvalidInput("elongation must be in [1, " + std::to_string(kMostElongation) + "]");
  if (o.elongation > 1 && o.growth == GrowthMethod::paper) throw InvalidInput("elongation needs guided growth");
  if (o.least_vertices > 0 && (o.elongation == 1 || o.deformable))
    throw InvalidInput("least_vertices needs an elongation above 1, and not deformable: else no vertices are left out");
  if (o.sweeps < 0) throw InvalidInput("sweeps must be >= 0");
  if (!(o.max_error.mm > 0 && o.max_error.relative > 0)) throw InvalidInput("max_error must be > 0");
  if (o.max_error.is_set() && o.sweeps == 0) throw InvalidInput("max_error needs sweeps to refine in");
  if (o.max_vertices < 1) throw InvalidInput("max_vertices must be > 0");
  if (o.threads < 0) throw InvalidInput("threads must be >= 0");
}

// Peak memory of a run per expected vertex: measured on surfaces of 4,000 to 600,000 vertices.
constexpr double kBytesPerVertex = 600;

// Describes the vessel that is thinnest for its length.
std::string thinnest_vessel(const Centerline& centerline) {
  Index longest = kNone;
  double most = 0;
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    const double radii = centerline.length(s) / centerline.radius_at(s, 0.5);
    if (radii > most) {
      most = radii;
      longest = s;
    }
  }
  if (longest == kNone) return {};
  std::ostringstream text;
  text << "the vessel thinnest for its length is segment " << longest << " at ("
       << centerline.point_at(longest, 0.5).transpose() << "): " << centerline.length(longest) << " mm at radius "
       << centerline.radius_at(longest, 0.5) << " mm. Check its radii, ";
  return text.str();
}

// What the surface would need, and how to need less.
struct Demand {
  std::string count, fewer;
};

Demand demand_of(const Centerline& centerline, const GenerateOptions& options, double expected) {
  std::ostringstream count, fewer;
  count << "about " << expected << " vertices";
  fewer << thinnest_vessel(centerline) << "ask for fewer vertices around"
        << (options.max_error.is_set() ? " or a larger error" : "");
  return {count.str(), fewer.str()};
}

double expected(const Centerline& centerline, const GenerateOptions& options) {
  return expected_vertices(centerline, options.around, options.max_error) / options.ring_spacing;
}

}  // namespace

GenerateOptions settled(const GenerateOptions& given, const Centerline& centerline) {
  check_options(given);
  check_scale(centerline);
  GenerateOptions options = given;
  options.around = std::max(options.around, least_around(centerline, options.max_error));
  const double vertices = expected(centerline, options);
  if (vertices > options.max_vertices) {
    const auto [count, fewer] = demand_of(centerline, options, vertices);
    throw InvalidInput(count + " would be needed, more than the " + std::to_string(options.max_vertices) +
                       " allowed; " + fewer + ", or allow more in all");
  }
  return options;
}

void require_memory_for(const Centerline& centerline, const GenerateOptions& options) {
  const double vertices = expected(centerline, options);
  const auto [count, fewer] = demand_of(centerline, options, vertices);
  require_memory(vertices * kBytesPerVertex, "a surface of " + count, fewer);
}

}  // namespace vmesh

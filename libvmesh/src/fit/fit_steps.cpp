#include "fit/fit_steps.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "fit/least_squares.h"
#include "fit/reshaping.h"

namespace vmesh::fitting {
namespace {

constexpr double kLongestStep = 0.35;  // of the edges around
constexpr int kShapePower = 2;
constexpr double kFarthestStart = 1.5;  // local radii, from the reference
// The pull to good shapes counts relative to distances, which shrink with the square of the edges: it grows with the
// square of edges by radius, between this and 1. Measured on portal vein 008 at 12 vertices around: mean distance .023
// mm with 1, .021 with this and with half of it; less than 1 at 6 around costs portal vein 002 its shape (skewness .144
// instead of .138 with five sixths).
constexpr double kLeastPull = 1.0 / 3;
constexpr int kRepairs = 4, kRepairPower = 8;

std::vector<ShapePull> shape_pulls(const FitMesh& surface, const VesselField& field) {
  const std::vector<Vec3> steps = shape_steps(surface, kShapePower);
  std::vector<ShapePull> pulls(steps.size());
  for (Index v = 0; v < pulls.size(); ++v) {
    const double share = surface.mean_edge(v) / widest_radius(field, surface.vertices()[v].cone);
    pulls[v] = {steps[v], std::clamp(share * share, kLeastPull, 1.0)};
  }
  return pulls;
}

}  // namespace

void step_nearer(FitMesh& surface, const Matches& matches, const FitSetting& setting, const std::vector<char>& frozen,
                 const LeastSquaresWeights& weights) {
  const std::vector<ShapePull> pulls =
      setting.even ? shape_pulls(surface, setting.field) : std::vector<ShapePull>(surface.vertices().size());
  std::vector<Vec3> steps = least_squares_steps(surface, matches, pulls, setting.opening_normals, frozen, weights);
  for (Index v = 0; v < steps.size(); ++v) {
    const double longest = kLongestStep * surface.mean_edge(v), norm = steps[v].norm();
    if (norm > longest) steps[v] *= longest / norm;
  }
  take_steps(surface, steps, setting.guard);
  find_cones(surface, setting.field);
}

double distance_from_reference(const Vec3& p, Index cone, const Vec3& normal, const FitSetting& setting) {
  const auto accepts = [&](Index g) {
    return (normal.isZero(0) || setting.reference.normal(g).dot(normal) > 0) &&
           same_vessel(setting.field, cone, setting.reference.cone(g));
  };
  const double limit = kFarthestStart * widest_radius(setting.field, cone);
  const auto found = setting.reference.index().closest_among(p, limit, accepts);
  return found ? found->distance : -1;
}

void find_cones(FitMesh& surface, const VesselField& field) {
  tbb::parallel_for(Index{0}, static_cast<Index>(surface.vertices().size()), [&](Index v) {
    surface.edit(v).cone = field.sample(surface.position(v), surface.vertex(v).cone).cone;
  });
}

void pack(FitMesh& surface, std::vector<Opening>& openings) {
  const std::vector<Index> number = surface.pack();
  for (Opening& opening : openings) {
    for (Index& v : opening.ring) v = number[v];
  }
}

void flip_closer(FitMesh& surface, const std::vector<char>& frozen, bool harsh, const FitSetting& setting) {
  flip_edges_closer(surface, frozen, harsh, [&](Index a, Index b, const Vec3& p) {
    const Vec3 normal = surface.vertex_normal(a) + surface.vertex_normal(b);
    return distance_from_reference(p, surface.vertices()[a].cone, normal, setting);
  });
}

void repair(FitMesh& surface, const std::vector<char>& frozen, const StepGuard& guard) {
  for (int i = 0; i < kRepairs; ++i) {
    if (!relax(surface, frozen, guard, kRepairPower, guard.max_skewness)) return;
  }
}

}  // namespace vmesh::fitting

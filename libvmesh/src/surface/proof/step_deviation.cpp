#include "surface/proof/step_deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmesh {
namespace {

constexpr double kMostDeviation = 0.5;  // radii, whatever the limit: the axis stays inside
constexpr double kTolerance = 1e-3;     // radii, of projections

// Weights of samples: a rule for triangles that is exact for cubic functions.
constexpr double kAtCentre = 27.0 / 60, kAtMiddle = 8.0 / 60, kAtCorner = 3.0 / 60;

// A face at the vertex of a step: the vertex, b, c.
struct Sector {
  Vertex b, c;
  double area;
};

}  // namespace

double StepDeviation::most(double radius) const { return std::min(limit_.at(radius), kMostDeviation * radius); }

// Calls visit(signed distance, share of the step's vertex in the point, weight, limit) for samples of the new faces.
template <class Visit>
void StepDeviation::visit_samples(Samples which, const Replacement& step, Visit&& visit) const {
  const BoundSurface& surface = state_.surface;
  const VesselField& field = state_.field;
  const Vec3& p = step.target.position;
  const double radius = field.radius_at(step.target.sample.cone, step.target.sample.t);
  std::vector<Sector> sectors;
  double area = 0;
  for (const FaceCorners& f : step.faces) {
    const auto at = static_cast<std::size_t>(std::find(f.begin(), f.end(), step.at) - f.begin());
    const Vertex b = f[(at + 1) % 3], c = f[(at + 2) % 3];
    sectors.push_back({b, c, 0.5 * (state_.point(b) - p).cross(state_.point(c) - p).norm()});
    area += sectors.back().area;
  }
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  for (const Sector& s : sectors) {
    const Vec3 &b = state_.point(s.b), &c = state_.point(s.c);
    const double limit = most(std::min({radius, surface.radius(s.b), surface.radius(s.c)}));
    const auto offer = [&](const Vec3& q, Vertex near, double share, double weight) {
      visit(field.sample_fast(q, surface.cone[near]).distance, share, weight, limit);
    };
    const auto before = std::find_if(sectors.begin(), sectors.end(), [&](const Sector& o) { return o.c == s.b; });
    const double both = s.area + (before == sectors.end() ? 0 : before->area);
    offer((p + b + c) / 3, s.b, 1.0 / 3, kAtCentre * s.area);
    offer(0.5 * (p + b), s.b, 0.5, kAtMiddle * both);
    const bool is_last = std::none_of(sectors.begin(), sectors.end(), [&](const Sector& o) { return o.b == s.c; });
    if (is_last) offer(0.5 * (p + c), s.c, 0.5, kAtMiddle * s.area);
    if (which == Samples::moving) continue;
    offer(0.5 * (b + c), s.b, 0, kAtMiddle * s.area);
    visit(surface.distance[s.b], 0, kAtCorner * both, kUnlimited);
    if (is_last) visit(surface.distance[s.c], 0, kAtCorner * s.area, kUnlimited);
  }
  visit(step.target.sample.distance, 1, kAtCorner * area, most(radius));
}

StepDeviation::Measured StepDeviation::measure(const Replacement& step) const {
  Measured result;
  visit_samples(Samples::all, step, [&](double distance, double, double weight, double limit) {
    result.largest = std::max(result.largest, std::abs(distance) / limit);
    result.squared += weight * distance * distance;
  });
  return result;
}

StepDeviation::Measured StepDeviation::measure(Face f) const {
  const FaceCorners corners = state_.corners(f);
  const Vertex a = corners[0];
  return measure({a, {state_.point(a), state_.surface.sample(a)}, {}, {corners}});
}

void StepDeviation::place(Replacement& step, const Vec3& p, Index hint, double share) const {
  step.target = project_to_boundary(state_.field, p, hint, kTolerance, 0);
  const FieldSample& sample = step.target.sample;
  double slope = 0, product = 0;
  visit_samples(Samples::moving, step, [&](double distance, double part, double weight, double) {
    slope += weight * part * part;
    product += weight * part * distance;
  });
  const double far = share * most(state_.field.radius_at(sample.cone, sample.t));
  const double height = slope > 0 ? std::clamp(-product / slope, -far, far) : 0;
  step.target.position += height * sample.gradient.normalized();
  step.target.sample = state_.field.sample_fast(step.target.position, sample.cone);
}

}  // namespace vmesh

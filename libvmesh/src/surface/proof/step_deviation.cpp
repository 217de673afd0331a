#include "surface/proof/step_deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace vmesh {
namespace {

// Radii, whatever the limit: the axis stays inside. With 0.35 and 0.7 errors and vertices stay within 0.3 %.
constexpr double kMostDeviation = 0.5;
constexpr double kDamping = 0.01;    // of steps, so that vertices do not slide where nothing is gained
constexpr double kTolerance = 1e-3;  // radii, of projections
constexpr double kNearZero = 0.02;   // radii: distances that need not be told from none; 0.005 and 0.1: within 1 %
constexpr int kIterations = 2;       // of reweighted least squares, from the same samples; 1: within 1 %

// Distances count to a power between that of the mean error (1), whose sum hardly tells which of many collapses is the
// better one, and squares, which spend vertices on thick vessels. Nine trees with a number of vertices, four of them
// synthetic: mean error at a power of 1.3 and 1.7 .7 and .8 % larger, at 2 with one iteration 3 %.
double powered(double distance) { return distance * std::sqrt(distance); }
// Its derivative, divided by the distance: the weight in least squares.
double least_squares_weight(double distance, double radius) { return 1 / std::sqrt(distance + kNearZero * radius); }

// Weights of samples: a rule for triangles that is exact for cubic functions.
constexpr double kAtCentre = 27.0 / 60, kAtMiddle = 8.0 / 60, kAtCorner = 3.0 / 60;

constexpr std::size_t kNoSector = std::numeric_limits<std::size_t>::max();
constexpr double kAnyShare = std::numeric_limits<double>::infinity();

}  // namespace

StepDeviation::StepDeviation(const SweepState& state, const ErrorLimit& limit)
    : state_(state), limit_(limit), rough_(state.field.relations().centerline(), state.field.relations().blend()) {}

// Never so far that the surface loses the axis.
double StepDeviation::most(double radius) const { return std::min(limit_.at(radius), kMostDeviation * radius); }

double StepDeviation::radius_of(const BoundaryPoint& at) const {
  return rough_.relations().radius_at(at.sample.cone, at.sample.t);
}

double StepDeviation::most(const BoundaryPoint& at) const { return most(radius_of(at)); }

StepDeviation::Fan StepDeviation::fan_of(const SurfaceStep& step, double share) const {
  const BoundSurface& surface = state_.surface;
  Fan fan;
  fan.share_ = share;
  fan.sectors_.reserve(step.faces.size());
  std::vector<std::array<Vertex, 2>> ends;
  for (const FaceCorners& f : step.faces) {
    const auto at = static_cast<std::size_t>(std::find(f.begin(), f.end(), step.vertex) - f.begin());
    const Vertex b = f[(at + 1) % 3], c = f[(at + 2) % 3];
    ends.push_back({b, c});
    fan.sectors_.push_back({state_.point(b), state_.point(c), surface[b].cone, surface[c].cone,
                            std::min(most(surface.radius(b)), most(surface.radius(c))),
                            powered(std::abs(surface[b].distance)), powered(std::abs(surface[c].distance)),
                            std::nullopt, true, kNoSector, true});
  }
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = 0; j < ends.size(); ++j) {
      if (ends[j][1] != ends[i][0]) continue;
      fan.sectors_[i].before = j;
      fan.sectors_[j].is_last = false;
    }
  }
  return fan;
}

std::vector<double> StepDeviation::areas(const Fan& fan, const Vec3& p) {
  std::vector<double> areas;
  areas.reserve(fan.sectors_.size());
  for (const Fan::Sector& s : fan.sectors_) areas.push_back(0.5 * (s.b - p).cross(s.c - p).norm());
  return areas;
}

// Of both faces at the edge from the step's vertex to the sector's b.
double StepDeviation::area_before(const Fan& fan, const std::vector<double>& areas, std::size_t sector) {
  const std::size_t before = fan.sectors_[sector].before;
  return areas[sector] + (before == kNoSector ? 0 : areas[before]);
}

std::optional<double> StepDeviation::measure(Fan& fan, const BoundaryPoint& at) const {
  const Vec3& p = at.position;
  const double most_here = most(at);
  if (std::abs(at.sample.distance) > fan.share_ * most_here) return std::nullopt;
  const std::vector<double> area = areas(fan, p);
  double sum = 0, whole = 0;
  // Adds a sample; returns whether it is near enough.
  const auto add = [&](const Fan::Sector& s, const Vec3& q, Index hint, double weight) {
    const double distance = std::abs(rough_.sample_fast(q, hint).distance);
    sum += weight * powered(distance);
    return distance <= fan.share_ * std::min(most_here, s.most);
  };
  for (std::size_t i = 0; i < area.size(); ++i) {
    const Fan::Sector& s = fan.sectors_[i];
    whole += area[i];
    if (!add(s, (p + s.b + s.c) / 3, s.cone_of_b, kAtCentre * area[i])) return std::nullopt;
  }
  for (std::size_t i = 0; i < area.size(); ++i) {
    const Fan::Sector& s = fan.sectors_[i];
    const double both = area_before(fan, area, i);
    if (!add(s, 0.5 * (p + s.b), s.cone_of_b, kAtMiddle * both)) return std::nullopt;
    if (s.is_last && !add(s, 0.5 * (p + s.c), s.cone_of_c, kAtMiddle * area[i])) return std::nullopt;
    sum += kAtCorner * both * s.of_b;
    if (s.is_last) sum += kAtCorner * area[i] * s.of_c;
  }
  for (std::size_t i = 0; i < area.size(); ++i) {
    Fan::Sector& s = fan.sectors_[i];
    if (!s.of_middle) s.of_middle = std::abs(rough_.sample_fast(0.5 * (s.b + s.c), s.cone_of_b).distance);
    if (*s.of_middle > fan.share_ * std::min(most_here, s.most)) return std::nullopt;
    sum += kAtMiddle * area[i] * powered(*s.of_middle);
  }
  return sum + kAtCorner * whole * powered(std::abs(at.sample.distance));
}

double StepDeviation::measure(Face f) const {
  const FaceCorners corners = state_.corners(f);
  const BoundaryPoint at{state_.point(corners[0]), state_.surface.sample(corners[0])};
  Fan fan = fan_of({corners[0], at, {}, {corners}}, kAnyShare);
  return *measure(fan, at);
}

BoundaryPoint StepDeviation::place(const Fan& fan, const Vec3& p, Index hint) const {
  BoundaryPoint at = project_to_boundary(rough_, p, hint, kTolerance, 0);
  const auto move_by = [&](const Vec3& move) {
    at.position += move;
    at.sample = rough_.sample_fast(at.position, at.sample.cone);
  };
  const Vec3 move = least_squares_move(moving_samples(fan, at), radius_of(at));
  const double length = move.norm();
  if (length > 0) move_by(std::min(1.0, reach_of(fan, at.position) / length) * move);
  const double excess = std::abs(at.sample.distance) - fan.share_ * most(at);
  if (excess > 0) move_by(-std::copysign(excess, at.sample.distance) * at.sample.gradient.normalized());
  return at;
}

std::vector<StepDeviation::Moving> StepDeviation::moving_samples(const Fan& fan, const BoundaryPoint& at) const {
  const Vec3& p = at.position;
  const std::vector<double> area = areas(fan, p);
  std::vector<Moving> samples;
  samples.reserve(2 * area.size() + 2);
  double whole = 0;
  const auto add = [&](const FieldSample& sample, double part, double weight) {
    samples.push_back({sample.distance, part * sample.gradient.normalized(), part, weight});
  };
  for (std::size_t i = 0; i < area.size(); ++i) {
    const Fan::Sector& s = fan.sectors_[i];
    whole += area[i];
    add(rough_.sample_fast((p + s.b + s.c) / 3, s.cone_of_b), 1.0 / 3, kAtCentre * area[i]);
    add(rough_.sample_fast(0.5 * (p + s.b), s.cone_of_b), 0.5, kAtMiddle * area_before(fan, area, i));
    if (s.is_last) add(rough_.sample_fast(0.5 * (p + s.c), s.cone_of_c), 0.5, kAtMiddle * area[i]);
  }
  add(at.sample, 1, kAtCorner * whole);
  return samples;
}

// A step of Gauss and Newton, with the weights of where the last one leads.
Vec3 StepDeviation::least_squares_move(const std::vector<Moving>& samples, double radius) {
  Vec3 move = Vec3::Zero();
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Vec3 product = Vec3::Zero();
    double total = 0;
    for (const Moving& s : samples) {
      const double weight = s.area * least_squares_weight(std::abs(s.distance + s.slope.dot(move)), radius);
      normal += weight * s.slope * s.slope.transpose();
      product += weight * s.distance * s.slope;
      total += weight * s.part * s.part;
    }
    if (total <= 0) return Vec3::Zero();
    normal.diagonal().array() += kDamping * total;
    move = -normal.ldlt().solve(product);
  }
  return move;
}

// The longest edge at the step's vertex.
double StepDeviation::reach_of(const Fan& fan, const Vec3& p) {
  double squared = 0;
  for (const Fan::Sector& s : fan.sectors_)
    squared = std::max({squared, (s.b - p).squaredNorm(), (s.c - p).squaredNorm()});
  return std::sqrt(squared);
}

}  // namespace vmesh

#include <array>
#include <cmath>
#include <numbers>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "vmesh/evaluation/vessel_distance.h"

namespace vmesh {
namespace {

// Radii: points less deep inside another cone count as on the boundary. Far above rounding, far below any relevant
// distance.
constexpr double kDepth = 1e-9;
constexpr std::size_t kBatch = 16384, kTogether = 256;  // samples
constexpr double kPlastic = 1.32471795724474602596;     // see sample_surface()

// The side of a round cone between the circles where it touches its end spheres.
struct ConeSide {
  Vec3 first, axis, across, other_across;  // the latter three are orthonormal
  double length, r0, r1, sine, cosine;     // of the angle between the side and the axis

  ConeSide(const CenterlineNode& a, const CenterlineNode& b)
      : first(a.position),
        axis((b.position - a.position).normalized()),
        across(axis.unitOrthogonal()),
        other_across(axis.cross(across)),
        length((b.position - a.position).norm()),
        r0(a.radius),
        r1(b.radius),
        sine((r0 - r1) / length),
        cosine(std::sqrt(std::max(0.0, 1 - sine * sine))) {}

  double area() const { return std::numbers::pi * (r0 + r1) * length * cosine * cosine; }

  // `u`, `v` in [0, 1): shares of the area along the axis, and around it.
  BoundarySample at(double u, double v) const {
    const double radius = std::sqrt(r0 * r0 + u * (r1 * r1 - r0 * r0));
    const double along = std::abs(r1 - r0) > 1e-9 * r0 ? (radius - r0) / (r1 - r0) : u;
    const double angle = 2 * std::numbers::pi * v;
    const Vec3 outward = cosine * (std::cos(angle) * across + std::sin(angle) * other_across) + sine * axis;
    return {first + along * length * axis + radius * outward, radius};
  }
};

BoundarySample on_sphere(const CenterlineNode& node, double u, double v) {
  const double z = 1 - 2 * u, ring = std::sqrt(std::max(0.0, 1 - z * z)), angle = 2 * std::numbers::pi * v;
  return {node.position + node.radius * Vec3(ring * std::cos(angle), ring * std::sin(angle), z), node.radius};
}

double sphere_area(const CenterlineNode& node) { return 4 * std::numbers::pi * node.radius * node.radius; }

class BoundarySampler {
 public:
  BoundarySampler(const VesselField& field, std::size_t count)
      : field_(field), centerline_(field.relations().centerline()) {
    double area = 0;
    for (Index s = 0; s < centerline_.segments().size(); ++s) area += side(s).area();
    if (!(area > 0)) {
      for (const CenterlineNode& node : centerline_.nodes()) area += sphere_area(node);
    }
    density_ = static_cast<double>(count) / area;
  }

  BoundarySamples run() {
    for (Index s = 0; s < centerline_.segments().size(); ++s) {
      const ConeSide cone = side(s);
      const auto [a, b] = centerline_.segment(s);
      spread(cone.area(), {a, b}, [&](double u, double v) { return cone.at(u, v); });
    }
    for (Index n = 0; n < centerline_.nodes().size(); ++n) {
      const CenterlineNode& node = centerline_.node(n);
      spread(sphere_area(node), {n, n}, [&](double u, double v) { return on_sphere(node, u, v); });
    }
    keep_boundary();
    return {std::move(samples_), density_};
  }

 private:
  ConeSide side(Index segment) const {
    const auto [a, b] = centerline_.segment(segment);
    return {centerline_.node(a), centerline_.node(b)};
  }

  template <class Place>
  void spread(double area, std::array<Index, 2> nodes, Place&& place) {
    area_ += area;
    for (; number_ + 0.5 < area_ * density_; ++number_) {
      const double u = std::fmod(0.5 + number_ / kPlastic, 1), v = std::fmod(0.5 + number_ / (kPlastic * kPlastic), 1);
      candidates_.push_back({place(u, v), nodes});
      if (candidates_.size() == kBatch) keep_boundary();
    }
  }

  // Keeps the candidates that are on the boundary.
  void keep_boundary() {
    kept_.resize(candidates_.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, candidates_.size(), kTogether), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i)
        kept_[i] = on_boundary(candidates_[i].sample, candidates_[i].nodes);
    });
    for (std::size_t i = 0; i < kept_.size(); ++i)
      if (kept_[i]) samples_.push_back(candidates_[i].sample);
    candidates_.clear();
  }

  // Tests neighbouring cones first: most points off the boundary are inside one of them.
  bool on_boundary(const BoundarySample& sample, std::array<Index, 2> nodes) const {
    const double deepest = -kDepth * sample.radius;
    for (const Index n : nodes) {
      for (const Index s : centerline_.incident_segments(n)) {
        if (field_.sample_cone(sample.position, s).distance < deepest) return false;
      }
    }
    return field_.sample_global(sample.position).distance >= deepest;
  }

  const VesselField& field_;
  const Centerline& centerline_;
  double density_;                // per mm^2
  double area_ = 0, number_ = 0;  // so far
  struct Candidate {
    BoundarySample sample;
    std::array<Index, 2> nodes;
  };
  std::vector<Candidate> candidates_;
  std::vector<char> kept_;
  std::vector<BoundarySample> samples_;
};

}  // namespace

BoundarySamples sample_boundary(const VesselField& field, std::size_t count) {
  return BoundarySampler(field, count).run();
}

}  // namespace vmesh

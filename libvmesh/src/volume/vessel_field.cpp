#include "vmesh/volume/vessel_field.h"

#include <array>
#include <cmath>
#include <limits>

#include "vmesh/core/ascending.h"
#include "vmesh/volume/field_excerpt.h"

namespace vmesh {
namespace {

// Relative to coordinates: covers the rounding in a distance and in the bound by which a cone is skipped.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

}  // namespace

VesselField::VesselField(const Centerline& centerline, double blend) : relations_(centerline, blend), blend_(blend) {
  finish();
}

VesselField::VesselField(const Centerline& centerline, const FieldExcerpt& excerpt)
    : relations_(centerline, excerpt), blend_(excerpt.blend) {
  finish();
}

void VesselField::finish() {
  make_cones();
  measure_spheres();
  build_tree();
  lonely_.assign(cones_.size(), not_asked);
}

void VesselField::make_cones() {
  cones_.reserve(relations_.cone_count());
  for (Index c = 0; c < relations_.cone_count(); ++c) {
    Cone cone = make_cone(relations_.centerline(), relations_.first_node(c), relations_.last_node(c));
    cone.rounding0 = relations_.rounding_of(cone.a);
    cone.rounding1 = relations_.rounding_of(cone.b);
    cones_.push_back(cone);
  }
  for (const auto& [i, j] : relations_.apart()) cones_[i].is_apart = cones_[j].is_apart = true;
}

void VesselField::measure_spheres() {
  spheres_.resize(cones_.size());
  for (Index c = 0; c < cones_.size(); ++c) {
    const Cone& cone = cones_[c];
    const Vec3 center = cone.origin + 0.5 * cone.axis;
    const double radius = 0.5 * cone.axis.norm() + max_radius(c);
    const double rounding = kRounding * (center.norm() + radius);
    spheres_[c] = {center, radius + 2 * blend_ * max_radius(c) + rounding};
  }
}

VesselField::Cone VesselField::make_cone(const Centerline& centerline, Index a, Index b) {
  return {RoundCone(centerline.node(a), centerline.node(b)), a, b};
}

FieldSample VesselField::sample_of(const Cone& cone, const Vec3& p, Index number) {
  const Distance d = cone.distance_to(p);
  return {d.value, cone.gradient(p, d.t), number, d.t};
}

FieldSample VesselField::sample_cone(const Vec3& p, Index cone) const { return sample_of(cones_[cone], p, cone); }

FieldSample ConeRelations::sample_cone(const Vec3& p, Index cone) const {
  return VesselField::sample_of(VesselField::make_cone(*centerline_, first_node(cone), last_node(cone)), p, cone);
}

FieldSample VesselField::sample(const Vec3& p, Index hint) const {
  FieldSample sample = blended_local(p, hint);
  while (sample.cone != hint) {  // ends: every step is to a closer cone, or to an equally close one of lower number
    hint = sample.cone;
    sample = blended_local(p, hint);
  }
  return sample;
}

FieldSample VesselField::blended(const Vec3& p, std::span<const Index> cones, Index first) const {
  // Kept between calls, so that a query allocates nothing.
  thread_local std::vector<Candidate> candidates;
  candidates.clear();
  const Distance nearby = cones_[first].distance_to(p);
  candidates.push_back({nearby.value, nearby.t, first});
  double least = nearby.value;
  // One pass keeps the cones within the widest possible blend of the best so far. After a cone out of reach it skips
  // those of its run that cannot be within reach, and cones whose bounding spheres are far.
  ConeRelations::Run out_of_reach;
  for (const Index c : cones) {
    const ConeRelations::Run& run = relations_.run(c);
    if (c == first || (run.number == out_of_reach.number && run.travel < out_of_reach.travel)) continue;
    const double reach = least + spheres_[c].reach;
    if (reach <= 0 || (p - spheres_[c].center).squaredNorm() >= reach * reach) continue;
    const Distance d = cones_[c].distance_to(p);
    const double excess = d.value - least - 2 * blend_ * max_radius(c);
    if (excess >= 0 && d.value > least) {  // of equally near cones the lowest number counts: they are all kept
      out_of_reach = {run.number, run.travel + excess};
      continue;
    }
    least = std::min(least, d.value);
    candidates.push_back({d.value, d.t, c});
  }
  std::erase_if(candidates, [&](const Candidate& c) {
    return c.value > least && c.value >= least + 2 * blend_ * max_radius(c.cone);
  });
  FieldSample sample;
  const auto best = std::min_element(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.value != b.value ? a.value < b.value : a.cone < b.cone;
  });
  sample = {best->value, cones_[best->cone].gradient(p, best->t), best->cone, best->t};
  if (blend_ > 0 && candidates.size() > 1) blend_candidates(p, candidates, sample);
  return sample;
}

// Cones that start at the same sphere have equal distances to the bit where that sphere is nearest; at a thick node of
// many branches that is nearly all of them. One of them represents the rest. Compares with a few predecessors, which is
// enough there.
std::span<VesselField::Candidate> VesselField::at_different_places(std::span<Candidate> candidates) const {
  constexpr std::size_t kLookBack = 8;
  std::size_t kept = 0;
  for (const Candidate& c : candidates) {
    const auto recent = candidates.subspan(kept - std::min(kept, kLookBack), std::min(kept, kLookBack));
    const bool known = c.t == 0 && std::any_of(recent.begin(), recent.end(), [&](const Candidate& other) {
                         const Cone& seen = cones_[other.cone];
                         return other.t == 0 && seen.a == cones_[c.cone].a && !seen.is_apart;
                       });
    if (!known) candidates[kept++] = c;
  }
  return candidates.first(kept);
}

// The least of the pairwise smooth minima: continuous, and the plain minimum where gradients agree. Few of the many
// pairs blend; several are tested at a time.
void VesselField::blend_candidates(const Vec3& p, std::span<Candidate> candidates, FieldSample& sample) const {
  constexpr std::size_t kBatch = 32;
  struct Batch {
    std::array<double, kBatch> value, reach, x, y, z, room;
  };
  candidates = at_different_places(candidates);
  for (Candidate& c : candidates) {
    const Cone& cone = cones_[c.cone];
    c.reach = blend_ * cone.radius_at(c.t) * cone.rounding_at(c.t);
    c.gradient = cone.gradient(p, c.t);
  }
  Batch batch;
  for (std::size_t begin = 0; begin < candidates.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, candidates.size() - begin);
    for (std::size_t j = 0; j < count; ++j) {
      const Candidate& c = candidates[begin + j];
      batch.value[j] = c.value;
      batch.reach[j] = c.reach;
      batch.x[j] = c.gradient.x();
      batch.y[j] = c.gradient.y();
      batch.z[j] = c.gradient.z();
    }
    for (const Candidate& low : candidates) {
      if (low.value - low.reach / 2 >= sample.distance) continue;
      const double reach = low.reach, x = low.gradient.x(), y = low.gradient.y(), z = low.gradient.z();
      for (std::size_t j = 0; j < count; ++j) {
        const double thinner = reach < batch.reach[j] ? reach : batch.reach[j];
        const double width = thinner * (1 - (x * batch.x[j] + y * batch.y[j] + z * batch.z[j]));
        batch.room[j] = width - (batch.value[j] - low.value);
      }
      for (std::size_t j = 0; j < count; ++j) {
        const double gap = batch.value[j] - low.value;
        if (batch.room[j] <= 0 || gap < 0) continue;
        const double width = batch.room[j] + gap;
        const double h = batch.room[j] / width;
        const double value = low.value - h * h * width / 4;
        if (value >= sample.distance || !are_blended(low.cone, candidates[begin + j].cone)) continue;
        sample.distance = value;
        sample.gradient = (1 - h / 2) * low.gradient + h / 2 * candidates[begin + j].gradient;
      }
    }
  }
}

FieldSample VesselField::sample_global(const Vec3& p) const {
  const double rounding = kRounding * p.norm();
  Index best = 0;
  double least = std::numeric_limits<double>::infinity(), limit = least;
  visit_near(p, limit, [&](Index c) {
    const double value = cones_[c].distance_to(p).value;
    if (value < least || (value == least && c < best)) {
      least = value;
      limit = value + rounding;
      best = c;
    }
  });
  if (blend_ == 0) return sample_cone(p, best);
  std::vector<Index> near;
  visit_near(p, limit, [&](Index c) { near.push_back(c); });
  sort_unique(near);
  return blended(p, near, best);
}

}  // namespace vmesh

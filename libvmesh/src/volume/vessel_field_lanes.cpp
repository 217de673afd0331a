// Local queries of a VesselField in single precision, several cones at once.
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>

#include "vmesh/volume/vessel_field.h"

#include "volume/cone_lanes.h"

namespace vmesh {
namespace {

// Radii from the hint up to which single precision is enough: there it is accurate to a few 1e-5 radii.
constexpr double kFar = 128;       // idle 90 to 179
constexpr double kLargest = 1e30;  // derived: its square is in the range of double, itself in that of float
// From hint to hint; after that, double precision decides between two that are equally near; idle 45 to 90.
constexpr int kMostSteps = 64;
// Radii around an axis within which it is recorded whether there are other cones; idle 1.8 to 3.5.
constexpr double kLonely = 2.5;
constexpr float kNowhere = -1e30f;  // derived: radius of a cone that is never near, in the range of float

// Relative: covers the rounding in a distance and in the bound by which lanes are skipped.
constexpr float kMargin = 1e-5f;  // idle 7e-6 to 1.4e-5

}  // namespace

// The local cones of a hint, relative to its midpoint, in units of a power of two near its size.
struct VesselField::Surroundings {
  std::uint64_t field = 0;
  Index hint = kNone;
  Vec3 center = Vec3::Zero();
  double unit = 1, per_unit = 1;  // mm
  double range = 0;               // units from the centre; 0: double precision only
  std::size_t first = 0;          // the hint's number
  std::vector<ConeLanes> lanes;
};

std::uint64_t VesselField::new_number() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

// Every thread caches the ones it used last: successive queries are nearly always near each other.
const VesselField::Surroundings& VesselField::surroundings(Index hint) const {
  constexpr std::size_t kKept = 256;
  thread_local std::vector<Surroundings> kept(kKept);
  Surroundings& s = kept[hint % kKept];
  if (s.field != number_ || s.hint != hint) survey(hint, s);
  return s;
}

void VesselField::survey(Index hint, Surroundings& s) const {
  const std::span<const Index> local = relations_.local_cones(hint);
  const Cone& own = cones_[hint];
  s.field = number_;
  s.hint = hint;
  s.range = 0;
  if (local.size() > kMostConeLanes * ConeLanes::kCount || !all_are_blended(local)) return;
  s.center = own.origin + 0.5 * own.axis;
  s.unit = std::exp2(std::ilogb(std::max(own.axis.norm(), max_radius(hint))));
  s.per_unit = 1 / s.unit;
  double range = std::numeric_limits<double>::infinity();
  for (const Index c : local) {
    const Cone& cone = cones_[c];
    const double within = kFar * std::min(cone.r0, cone.r1) * s.per_unit;
    const double extent = ((cone.origin - s.center).norm() + cone.axis.norm()) * s.per_unit;
    const bool fits = extent <= within && within < kLargest && cone.inv_length2 * s.unit * s.unit < kLargest &&
                      std::abs(cone.lag) * s.unit < kLargest;
    if (!fits) return;
    range = std::min(range, within);
  }
  s.range = range;
  s.first = static_cast<std::size_t>(std::lower_bound(local.begin(), local.end(), hint) - local.begin());
  s.lanes.resize((local.size() + ConeLanes::kCount - 1) / ConeLanes::kCount);
  for (std::size_t b = 0; b < s.lanes.size(); ++b)
    fill_lanes(local.subspan(b * ConeLanes::kCount, std::min(ConeLanes::kCount, local.size() - b * ConeLanes::kCount)),
               s.center, s.per_unit, s.lanes[b]);
}

bool VesselField::all_are_blended(std::span<const Index> cones) const {
  for (std::size_t i = 0; i < cones.size(); ++i) {
    if (!cones_[cones[i]].is_apart) continue;
    for (std::size_t j = 0; j < i; ++j) {
      if (!are_blended(cones[j], cones[i])) return false;
    }
  }
  return true;
}

// Determined once and kept.
bool VesselField::is_lonely(Index cone, const Vec3& low, const Vec3& high) const {
  const std::atomic_ref<char> known(lonely_[cone]);
  if (known.load(std::memory_order_relaxed) == not_asked) {
    const std::span<const Index> local = relations_.local_cones(cone);
    const auto is_other = [&](Index item) {
      return !std::binary_search(local.begin(), local.end(), cone_of_item_[item]);
    };
    const bool alone = local.size() == cones_.size() || !tree_.any_overlapping(low, high, is_other);
    known.store(alone ? lonely : in_company, std::memory_order_relaxed);
  }
  return known.load(std::memory_order_relaxed) == lonely;
}

double VesselField::distance_to_others(const Vec3& p, Index cone, double limit) const {
  const double reach = std::max(limit, 0.0), around = kLonely * max_radius(cone);
  const Vec3 begin = cones_[cone].origin, end = begin + cones_[cone].axis;
  const Vec3 low = begin.cwiseMin(end).array() - around, high = begin.cwiseMax(end).array() + around;
  if ((p.array() - reach > low.array()).all() && (p.array() + reach < high.array()).all() && is_lonely(cone, low, high))
    return limit;
  const std::span<const Index> local = relations_.local_cones(cone);
  visit_near(p, limit, [&](Index c) {
    if (!std::binary_search(local.begin(), local.end(), c)) limit = std::min(limit, cones_[c].distance_to(p).value);
  });
  return limit;
}

void VesselField::fill_lanes(std::span<const Index> cones, const Vec3& center, double per_unit,
                             ConeLanes& lanes) const {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (std::size_t i = 0; i < ConeLanes::kCount; ++i) {
    const bool is_one = i < cones.size();
    const Cone cone = is_one ? cones_[cones[i]] : Cone();
    const Vec3 origin = is_one ? Vec3(per_unit * (cone.origin - center)) : Vec3(Vec3::Zero());
    const Vec3 axis = is_one ? Vec3(per_unit * cone.axis) : Vec3(Vec3::Zero());
    lanes.origin_x[i] = static_cast<float>(origin.x());
    lanes.origin_y[i] = static_cast<float>(origin.y());
    lanes.origin_z[i] = static_cast<float>(origin.z());
    lanes.axis_x[i] = static_cast<float>(axis.x());
    lanes.axis_y[i] = static_cast<float>(axis.y());
    lanes.axis_z[i] = static_cast<float>(axis.z());
    lanes.r0[i] = is_one ? static_cast<float>(per_unit * cone.r0) : kNowhere;
    lanes.taper[i] = static_cast<float>(per_unit * (cone.r1 - cone.r0));
    lanes.rounding[i] = static_cast<float>(cone.rounding0);
    lanes.rounding_taper[i] = static_cast<float>(cone.rounding1 - cone.rounding0);
    lanes.inv_length2[i] = static_cast<float>(cone.inv_length2 / (per_unit * per_unit));
    lanes.lag[i] = static_cast<float>(cone.lag / per_unit);
    lanes.t_low[i] = static_cast<float>(cone.t_low);
    lanes.t_high[i] = static_cast<float>(cone.t_high);
    lanes.reach[i] = is_one ? static_cast<float>(2 * blend_ * per_unit * max_radius(cones[i])) : 0;
    if (!is_one) continue;
    low = low.cwiseMin(origin).cwiseMin(origin + axis);
    high = high.cwiseMax(origin).cwiseMax(origin + axis);
  }
  const Vec3 middle = 0.5 * (low + high);
  double radius = 0;
  for (const Index c : cones) {
    const double widest = (1 + 2 * blend_) * max_radius(c);
    for (const double t : {0.0, 1.0})
      radius = std::max(
          radius, (per_unit * (cones_[c].origin + t * cones_[c].axis - center) - middle).norm() + per_unit * widest);
  }
  lanes.center_x = static_cast<float>(middle.x());
  lanes.center_y = static_cast<float>(middle.y());
  lanes.center_z = static_cast<float>(middle.z());
  lanes.radius = static_cast<float>(radius * (1 + kMargin) + kMargin * middle.norm());
}

LaneSampler& lane_sampler(InstructionSet set) { return VMESH_VARIANT(set, sample_lanes); }

FieldSample VesselField::sample_fast(const Vec3& p, Index hint) const {
  if (only_double_) return sample(p, hint);
  static LaneSampler& run = lane_sampler(best_instruction_set());
  Index before = kNone;
  for (int step = 0; step < kMostSteps; ++step) {
    const Surroundings& s = surroundings(hint);
    const Vec3 q = s.per_unit * (p - s.center);
    if (!(q.squaredNorm() <= s.range * s.range)) break;
    const LaneSample found = run(s.lanes.data(), s.lanes.size(),
                                 {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
                                  static_cast<float>(blend_), s.first});
    const Index nearest = relations_.local_cones(hint)[found.nearest];
    if (nearest == hint)
      return {s.unit * found.distance, Vec3(found.gradient_x, found.gradient_y, found.gradient_z), nearest, found.t};
    // Distances are rounded differently around every hint: of two equally near cones, each may find the other nearer.
    if (nearest == before) break;
    before = hint;
    hint = nearest;
  }
  return sample(p, hint);
}

}  // namespace vmesh

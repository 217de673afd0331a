// Surroundings: the potential of contact, friction and jaws, its slopes, and the forces at the end of a step.
#include <algorithm>
#include <cmath>

#include "deform/surroundings.h"

namespace vmesh {
namespace {

/// Pairs that are as near at rest as their barriers reach are within it by rounding.
constexpr double kHardly = 1e-6;
/// What will come within reach is pushed ahead, to this share of the reach.
constexpr double kAhead = 0.5;
/// Gaps below this share of the reach open as if they were as wide: a barrier's own slope only doubles them. They are
/// not made narrower.
constexpr double kOpensAs = 1e-3;

/// Where what runs into each other is stopped, as a share of the gap, or of the barrier's reach if that is less.
constexpr double kStopsAt = 0.5;
/// What meets within this many times the way to where the first meet is stopped with these.
constexpr double kSoon = 2;
/// Parts of a way at which the deepest place is looked for.
constexpr int kLooks = 8;
/// A step has converged when nothing moves by more than this share of a barrier's reach, and times what friction
/// yields.
constexpr double kConverged = 4e-2, kFrictionConverged = 5;

Mat3 along(const Vec3& n, double stiffness) { return stiffness * n * n.transpose(); }
Vec3 across(const Vec3& n, const Vec3& v) { return v - n.dot(v) * n; }

}  // namespace

SegmentLoad& Surroundings::load(Index slot) {
  if (load_of_slot_[slot] == kNone) {
    load_of_slot_[slot] = static_cast<Index>(loaded_slots_.size());
    loaded_slots_.push_back(slot);
    loads_.resize(std::max(loads_.size(), loaded_slots_.size()));
    loads_[load_of_slot_[slot]] = {};
  }
  return loads_[load_of_slot_[slot]];
}

void Surroundings::press(Index slot, double t, const Mat3& stiffness, const Vec3& gradient) {
  SegmentLoad& l = load(slot);
  const double u = parent_[slot] == slot ? 1 : t, p = 1 - u;
  l.pp += p * p * stiffness, l.pu += p * u * stiffness, l.uu += u * u * stiffness;
  l.gradient_p += p * gradient, l.gradient_u += u * gradient;
}

void Surroundings::linearise(double part) {
  for (const Index slot : loaded_slots_) load_of_slot_[slot] = kNone;
  loaded_slots_.clear();
  links_.clear();
  add_contacts(part);
  add_friction(part);
  add_jaws(part);
}

/// An instrument that goes on narrows the gap. One that recedes leaves the barrier as it is; it never pulls.
void Surroundings::add_contacts(double part) {
  for (const ContactPair& pair : pairs_) {
    const auto& [gap, s, t, n] = pair.now;
    const double reach = pair.barrier.reach;
    const Vec3 goes = pair.is_part
                          ? Vec3(part * (on_part(pair.other, t, points_.aim) - on_part(pair.other, t, points_.present)))
                          : Vec3::Zero();
    const double push = n.dot(goes);
    if (std::abs(gap - reach) <= kHardly * reach && push <= 0) continue;
    if (gap >= reach && gap - push >= kAhead * reach) continue;
    const bool ahead = gap >= reach;
    const double at = ahead ? kAhead * reach : std::max(gap, kOpensAs * reach);
    const double stiffness = pair.barrier.curvature(at);
    const double slope = (ahead ? 0 : pair.barrier.slope(at)) + stiffness * (gap - at - push);
    if (slope >= 0) continue;
    if (pair.is_part)
      press(pair.slot, s, along(n, stiffness), slope * n);
    else if (stiffness > 0)
      links_.push_back({pair.slot, pair.other, s, t, n, stiffness, slope});
  }
}

/// Barriers are soft from afar. What would run into each other in a long step is stopped a share of the gap before,
/// along the direction in which it meets: first what meets first. A stop that pulls is left out again, while `revises`.
bool Surroundings::stop(const RodScene& scene, double part, bool revises) {
  cover_trial(scene);
  const bool had_loads = !loaded_slots_.empty();
  const std::size_t before = stops_.size();
  if (revises)
    std::erase_if(stops_,
                  [this](const Stop& stop) { return way_at(stop, trial_) > stop.way + 1e-9 * std::abs(stop.way); });
  const bool left_out = stops_.size() < before;
  std::vector<double> free(pairs_.size(), 1);
  double first = 1;
  for (std::size_t i = 0; i < pairs_.size(); ++i) first = std::min(first, free[i] = free_part_of(pairs_[i]));
  if (first >= 1 && !left_out) return false;
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (free[i] < 1 && free[i] <= kSoon * first) add_stop(pairs_[i], free[i], part);
  linearise(part);
  for (const Stop& stop : stops_) press_stop(stop);
  loads_changed_ = had_loads || !loaded_slots_.empty();  // pairs may be others now, too
  return true;
}

double Surroundings::way_at(const Stop& stop, const std::vector<Vec3>& positions) const {
  const auto way = [&](Index slot, double t) { return Vec3(on_slot(slot, t, positions) - on_slot(slot, t, present_)); };
  const Vec3 first = way(stop.slot, stop.first_t);
  return stop.direction.dot(stop.is_part ? first : Vec3(first - way(stop.other, stop.second_t)));
}

/// Not farther than to where they meet. Where two roll on each other, or one goes around the other, the place at which
/// they meet is not where they get into each other: there the whole way is moved so that they do not.
void Surroundings::add_stop(const ContactPair& pair, double free, double part) {
  const PairMotion motion = motion_of(pair);
  const double reach = pair.barrier.reach;
  const double left = (pair.now.gap < 2 * kOpensAs * reach ? 1 : kStopsAt) * std::min(pair.now.gap, reach);
  const auto stop_after = [&](double at) {
    const ConeGap meets = gap_between(between(motion.first, at), between(motion.second, at));
    const double stiffness =
        pair.is_part ? stop_stiffness_[pair.slot] : std::min(stop_stiffness_[pair.slot], stop_stiffness_[pair.other]);
    // `way`: what lacks for now.
    return Stop{pair.slot,      pair.other,      pair.is_part, meets.first_t,
                meets.second_t, meets.direction, stiffness,    left - meets.gap};
  };
  Stop stop = stop_after(free);
  stop.way += free * way_at(stop, trial_);
  if (pair.is_part)
    stop.way += (1 - free) * part *
                stop.direction.dot(on_part(pair.other, stop.second_t, points_.aim) -
                                   on_part(pair.other, stop.second_t, points_.present));
  if (way_at(stop, trial_) >= stop.way) {
    const double deepest = deepest_part(motion, free);
    stop = stop_after(deepest);
    stop.way = way_at(stop, trial_) + stop.way / deepest;
  }
  stops_.push_back(stop);
}

/// Of the rest of the way.
double Surroundings::deepest_part(const PairMotion& motion, double free) {
  double deepest = 1, least = HUGE_VAL;
  for (int i = 1; i <= kLooks; ++i) {
    const double part = free + (1 - free) * i / kLooks;
    const double gap = gap_between(between(motion.first, part), between(motion.second, part)).gap;
    if (gap < least) least = gap, deepest = part;
  }
  return deepest;
}

void Surroundings::press_stop(const Stop& stop) {
  if (stop.is_part)
    press(stop.slot, stop.first_t, along(stop.direction, stop.stiffness), -stop.stiffness * stop.way * stop.direction);
  else
    links_.push_back({stop.slot, stop.other, stop.first_t, stop.second_t, stop.direction, stop.stiffness,
                      -stop.stiffness * stop.way});
}

void Surroundings::note_friction(const RodScene& scene) {
  std::vector<Rub> before = std::move(rubs_);
  rubs_.clear();
  for (const ContactPair& pair : pairs_) {
    const auto& [gap, s, t, n] = pair.now;
    const Index instrument = pair.is_part ? parts_[pair.other].instrument : kNone;
    const double friction = pair.is_part ? instruments_[instrument].shape.friction : options_.friction;
    const double load = -friction * pair.barrier.slope(gap);
    if (!(load > 0)) continue;
    const double radius = cone_of(pair.slot, present_).radius_at(s);
    Rub rub{pair.slot,
            pair.other,
            pair.is_part,
            s,
            t,
            n,
            Vec3::Zero(),
            load,
            options_.slip_radii_per_s * radius * scene.options.step_s,
            on_slot(pair.slot, s, present_),
            Vec3::Zero(),
            Vec3::Zero()};
    if (pair.is_part) {
      rub.surface = part_cone(pair.other, points_.present).radius_at(t) * n;
      rub.second_start = on_part(pair.other, t, points_.present);
    } else {
      rub.second_start = on_slot(pair.other, t, present_);
    }
    rubs_.push_back(rub);
  }
  expect_ways(before);
}

/// What rubbed in the last step, too, goes on as it did: `expected` there has become the way of that step.
void Surroundings::expect_ways(const std::vector<Rub>& before) {
  expects_ = true;
  std::size_t next = 0;  // both are in the order of pairs, mostly
  for (Rub& rub : rubs_)
    for (std::size_t tried = 0; tried < before.size(); ++tried) {
      const std::size_t i = (next + tried) % before.size();
      const Rub& old = before[i];
      if (old.slot != rub.slot || old.other != rub.other || old.is_part != rub.is_part) continue;
      rub.expected = across(rub.normal, old.expected);
      next = i + 1;
      break;
    }
}

/// How far the instrument's surface has gone at a contact since the start of the step.
Vec3 Surroundings::surface_way(const Rub& rub, State state) const {
  const Instrument& i = instruments_[parts_[rub.other].instrument];
  const InstrumentPose& pose = state == State::trial ? i.trial : i.at;
  const Vec3 turned = pose.rotation * (i.start.rotation.conjugate() * rub.surface) - rub.surface;
  return on_part(rub.other, rub.second_t, state == State::trial ? points_.trial : points_.present) - rub.second_start +
         turned;
}

/// The way along the contact since the start of the step, of the first relative to the second.
Vec3 Surroundings::slipped(const Rub& rub, const std::vector<Vec3>& positions, State state) const {
  const Vec3 second =
      rub.is_part ? surface_way(rub, state) : Vec3(on_slot(rub.other, rub.second_t, positions) - rub.second_start);
  return across(rub.normal, Vec3(on_slot(rub.slot, rub.first_t, positions) - rub.first_start - second));
}

/// Stiff across the way, soft along it, where friction hardly grows any more. About the way so far, or, before anything
/// has moved, about the way expected.
void Surroundings::add_friction(double part) {
  for (const Rub& rub : rubs_) {
    const Vec3 so_far = slipped(rub, present_, State::present), way = expects_ ? rub.expected : so_far;
    const double length = way.norm(), sideways = rub.load * Slipping{rub.yield}.slope_over_way(length);
    const double lengthwise = rub.load * Slipping{rub.yield}.curvature(length);
    const Vec3 x = length > 0 ? Vec3(way / length) : rub.normal.unitOrthogonal(), y = rub.normal.cross(x);
    if (rub.is_part) {
      const Mat3 stiffness = along(x, lengthwise) + along(y, sideways);
      const Vec3 goes =
          part * (on_part(rub.other, rub.second_t, points_.aim) - on_part(rub.other, rub.second_t, points_.present));
      press(rub.slot, rub.first_t, stiffness, sideways * way + stiffness * (so_far - way - goes));
      continue;
    }
    // A link needs some stiffness; a thousandth of that at rest does not show.
    const double least = 1e-3 * rub.load / rub.yield;
    const double stiff_x = std::max(lengthwise, least), stiff_y = std::max(sideways, least);
    const Vec3 behind = so_far - way;
    links_.push_back(
        {rub.slot, rub.other, rub.first_t, rub.second_t, x, stiff_x, sideways * length + stiff_x * x.dot(behind)});
    links_.push_back({rub.slot, rub.other, rub.first_t, rub.second_t, y, stiff_y, stiff_y * y.dot(behind)});
  }
}

void Surroundings::add_jaws(double part) {
  for (const Jaw& jaw : jaws_) {
    if (!jaw.holds) continue;
    const Vec3 way = on_slot(jaw.slot, jaw.t, present_) - jaw.at - part * (jaw.aim - jaw.at);
    const double stiffness = jaw.slope_over_way(way.norm());
    press(jaw.slot, jaw.t, stiffness * Mat3::Identity(), stiffness * way);
  }
}

double Surroundings::friction_energy(const std::vector<Vec3>& positions, State state) const {
  double energy = 0;
  for (const Rub& rub : rubs_) energy += rub.load * Slipping{rub.yield}.energy(slipped(rub, positions, state).norm());
  return energy;
}

double Surroundings::jaw_energy(const std::vector<Vec3>& positions, State state) const {
  double energy = 0;
  for (std::size_t i = 0; i < jaws_.size(); ++i) {
    if (!jaws_[i].holds) continue;
    const Vec3& at = state == State::trial ? jaw_trial_[i] : jaws_[i].at;
    energy += jaws_[i].energy((on_slot(jaws_[i].slot, jaws_[i].t, positions) - at).norm());
  }
  return energy;
}

double Surroundings::energy(State state) {
  double energy = 0;
  if (state == State::trial) set_balls(trial_);
  for (ContactPair& pair : pairs_) {
    if (state == State::trial) pair.next = gap_or_less(pair, trial_, points_.trial);
    energy += pair.barrier.energy(state == State::trial ? pair.next.gap : pair.now.gap);
  }
  const std::vector<Vec3>& positions = state == State::trial ? trial_ : present_;
  return energy + friction_energy(positions, state) + jaw_energy(positions, state);
}

double Surroundings::energy_at(const std::vector<Vec3>& positions) {
  double energy = friction_energy(positions, State::trial) + jaw_energy(positions, State::trial);
  set_balls(positions);
  for (const ContactPair& pair : pairs_) energy += pair.barrier.energy(gap_or_less(pair, positions, points_.trial).gap);
  return energy;
}

double Surroundings::stored() const {
  double energy = jaw_energy(present_, State::present);
  for (const ContactPair& pair : pairs_) energy += pair.barrier.energy(pair.now.gap);
  return energy;
}

double Surroundings::smallest_gap() const {
  double smallest = HUGE_VAL;
  for (const ContactPair& pair : pairs_)
    if (pair.now.gap < smallest) smallest = std::min(smallest, gap_of(pair, present_, points_.present).gap);
  return smallest;
}

double Surroundings::precision() const {
  double precision = HUGE_VAL;
  for (const ContactPair& pair : pairs_)
    if (pair.now.gap < pair.barrier.reach) precision = std::min(precision, kConverged * pair.barrier.reach);
  for (const Rub& rub : rubs_) precision = std::min(precision, kFrictionConverged * rub.yield);
  return precision;
}

bool Surroundings::acts() const {
  return std::any_of(pairs_.begin(), pairs_.end(), [](const ContactPair& p) { return p.now.gap < p.barrier.reach; });
}

double Surroundings::end(const RodScene& scene) {
  double work = act_on_instruments();
  for (Rub& rub : rubs_) rub.expected = slipped(rub, present_, State::present);
  for (Jaw& jaw : jaws_) {
    if (!jaw.holds) continue;
    const Vec3 way = on_slot(jaw.slot, jaw.t, present_) - jaw.at;
    const double pull = jaw.slope_over_way(way.norm());
    work -= pull * way.dot(jaw.at - jaw.start);
    if (jaw.stiffness * way.norm() > jaw.slips_mN) slide(scene, jaw);
  }
  return work;
}

/// Forces of the step's end on all instruments; returns the work that their movement in this step did.
double Surroundings::act_on_instruments() {
  for (Instrument& i : instruments_) {
    i.force = {};
    i.force.behind_mm = (i.aim.position_mm - i.at.position_mm).norm();
  }
  double work = 0;
  for (const ContactPair& pair : pairs_) {
    if (!pair.is_part || pair.now.gap >= pair.barrier.reach) continue;
    const auto& [gap, s, t, n] = pair.now;
    const Vec3 force = pair.barrier.slope(gap) * n;  // on the instrument
    const Vec3 axis = on_part(pair.other, t, points_.present);
    Instrument& i = instruments_[parts_[pair.other].instrument];
    push_instrument(i, axis + part_cone(pair.other, points_.present).radius_at(t) * n, force);
    ++i.force.contacts;
    work -= force.dot(axis - on_part(pair.other, t, points_.start));
  }
  for (const Rub& rub : rubs_) {
    if (!rub.is_part) continue;
    const Vec3 way = slipped(rub, present_, State::present), goes = surface_way(rub, State::present);
    const Vec3 force = rub.load * Slipping{rub.yield}.slope_over_way(way.norm()) * way;
    push_instrument(instruments_[parts_[rub.other].instrument], rub.second_start + rub.surface + goes, force);
    work -= force.dot(goes);
  }
  return work;
}

void Surroundings::push_instrument(Instrument& instrument, const Vec3& at, const Vec3& force_mN) {
  instrument.force.force_N += 1e-3 * force_mN;
  instrument.force.torque_N_mm += 1e-3 * (at - instrument.at.position_mm).cross(force_mN);
}

/// The vessel slips through the jaws until they pull along it with what they can hold. Where that does not suffice,
/// because they are pulled off sideways or at its end, they lose it.
void Surroundings::slide(const RodScene& scene, Jaw& jaw) {
  const Vec3 way = on_slot(jaw.slot, jaw.t, present_) - jaw.at;
  const Vec3 axis = present_[jaw.slot] - present_[parent_[jaw.slot]];
  const double length = axis.norm(), elastic = jaw.slips_mN / jaw.stiffness;
  if (!(length > 0)) {
    jaw.holds = false;
    return;
  }
  const double lengthwise = way.dot(axis) / length,
               sideways = std::sqrt(std::max(0.0, way.squaredNorm() - lengthwise * lengthwise));
  if (sideways > elastic) {
    jaw.holds = false;
    return;
  }
  const double kept = std::sqrt(elastic * elastic - sideways * sideways);
  double shift = std::copysign(std::abs(lengthwise) - kept, lengthwise);  // of the jaws, towards the parent
  jaw.t -= shift / length;
  if (jaw.t < 0) {
    const double beyond = -jaw.t * length;
    const Index parent = parent_[jaw.slot];
    if (scene.is_root(parent)) {
      jaw.holds = false;
    } else {
      jaw.slot = parent;
      const double above = (present_[parent] - present_[parent_[parent]]).norm();
      jaw.t = above > 0 ? std::max(0.0, 1 - beyond / above) : 0;
    }
  } else if (jaw.t > 1) {
    const double beyond = (jaw.t - 1) * length;
    const Index child = straightest_child(scene, jaw.slot);
    if (child == kNone) {
      jaw.holds = false;
    } else {
      jaw.slot = child;
      const double below = (present_[child] - present_[parent_[child]]).norm();
      jaw.t = below > 0 ? std::min(1.0, beyond / below) : 1;
    }
  }
}

Index Surroundings::straightest_child(const RodScene& scene, Index slot) const {
  const Vec3 axis = present_[slot] - present_[parent_[slot]];
  Index best = kNone;
  double straightest = -HUGE_VAL;
  for (Index c = scene.rods[slot].first_child; c != kNone; c = scene.rods[c].next_sibling) {
    const double straight = axis.dot((present_[c] - present_[slot]).stableNormalized());
    if (straight > straightest) straightest = straight, best = c;
  }
  return best;
}

Vec3 Surroundings::slope_at(Index slot) const {
  Vec3 slope = Vec3::Zero();
  const auto add = [&](Index segment, double t, const Vec3& gradient) {
    const double u = parent_[segment] == segment ? 1 : t;
    if (segment == slot) slope += u * gradient;
    if (parent_[segment] == slot && segment != slot) slope += (1 - u) * gradient;
  };
  for (const ContactPair& pair : pairs_) {
    if (pair.now.gap >= pair.barrier.reach) continue;
    const Vec3 gradient = pair.barrier.slope(pair.now.gap) * pair.now.direction;
    add(pair.slot, pair.now.first_t, gradient);
    if (!pair.is_part) add(pair.other, pair.now.second_t, -gradient);
  }
  for (const Rub& rub : rubs_) {
    const Vec3 way = slipped(rub, present_, State::present);
    const Vec3 gradient = rub.load * Slipping{rub.yield}.slope_over_way(way.norm()) * way;
    add(rub.slot, rub.first_t, gradient);
    if (!rub.is_part) add(rub.other, rub.second_t, -gradient);
  }
  for (const Jaw& jaw : jaws_) {
    if (!jaw.holds) continue;
    const Vec3 way = on_slot(jaw.slot, jaw.t, present_) - jaw.at;
    add(jaw.slot, jaw.t, jaw.slope_over_way(way.norm()) * way);
  }
  return slope;
}

}  // namespace vmesh

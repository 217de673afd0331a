// Compiled once for every instruction set.
#include "deform/rod_kernels.h"

#include "deform/lanes.h"
#include "deform/lanes_matrix.h"

namespace vmesh::VMESH_INSTRUCTION_SET {
namespace {

/// Strain up to which tension counts in full: beyond, its stiffness would swamp that of the springs in rounding.
constexpr double kMostTautness = 10;

VMESH_INLINE Lanes3 read(const std::vector<Vec3>& from, const RodBatch& b) {
  Lanes3 r;
#pragma GCC unroll 4
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double* v = from[b.slot[i]].data();
    r.x[i] = v[0], r.y[i] = v[1], r.z[i] = v[2];
  }
  return r;
}

VMESH_INLINE LaneMask holds(const RodBatch& b, bool clamped_only) {
  LaneMask m;
  for (std::size_t i = 0; i < kLanes; ++i)
    m[i] = b.hold[i] == Hold::clamped || (!clamped_only && b.hold[i] == Hold::fixed) ? -1 : 0;
  return m;
}

/// Twice the inertial energy with respect to the prediction, and its gradient. A held slot follows its target, so its
/// inertia is not part of the objective.
VMESH_INLINE Lanes evaluate_inertia(RodBatch& b, const LanesPose& pose, LaneMask m) {
  const Lanes3 off = pose.position - b.predicted_position;
  const Lanes3 &x = pose.frame.x, &y = pose.frame.y;
  const LanesSpatial gradient{b.step_mass * off, -b.step_inertia * (cross(x, b.predicted_x) + cross(y, b.predicted_y))};
  b.gradient = select(m, gradient, b.gradient);
  Lanes linear = b.step_mass * square(off);
  if (b.held) linear = holds(b, false) ? all(0) : linear;
  return linear + b.step_inertia * (square(x - b.predicted_x) + square(y - b.predicted_y));
}

void begin(RodBatch& b, const char* active, const RodScene& scene, BeginSums& sums) {
  const LaneMask m = mask_of(active);
  b.held = false;
  for (std::size_t i = 0; i < kLanes; ++i) {
    b.hold[i] = scene.hold[b.slot[i]];
    b.held = b.held || b.hold[i] != Hold::free;
  }
  LanesPose& pose = b.pose[0];
  if (b.held) b.target = read(scene.target, b);
  const double step = scene.options.step_s, reach = step / (1 + scene.options.drag_per_s * step);
  const Lanes3 torque = read(scene.torque, b), force = read(scene.force, b);
  const Lanes3 old_velocity = read(scene.velocity, b), old_spin = read(scene.spin, b);
  const Lanes3& z = pose.frame.z;
  const Lanes axial = dot(old_spin, z);
  const Lanes kinetic = 0.5 * (b.mass * square(old_velocity) + b.inertia * (square(old_spin) + axial * axial));
  const Vec3& g = scene.options.gravity_mm_s2;
  const Lanes3 gravity{all(g.x()), all(g.y()), all(g.z())};
  const Lanes3 velocity = old_velocity + all(step) * (gravity + 1 / b.mass * force);
  const Lanes3 spin = old_spin + step / b.inertia * (torque - 0.5 * dot(z, torque) * z);
  const Lanes3 position = pose.position + all(reach) * velocity;
  const Lanes3 x = pose.frame.x + all(reach) * cross(spin, pose.frame.x);
  const Lanes3 y = pose.frame.y + all(reach) * cross(spin, pose.frame.y);
  b.predicted_position = select(m, position, b.predicted_position);
  b.predicted_x = select(m, x, b.predicted_x);
  b.predicted_y = select(m, y, b.predicted_y);
  b.spring_gradient = select(m, b.elastic_gradient, b.spring_gradient);
  const Lanes value = 0.5 * evaluate_inertia(b, pose, m) + b.elastic;
  sums.value += m ? value : all(0);
  sums.energy += m ? kinetic + b.elastic : all(0);
}

/// D and b in series with the spring, as seen from the parent: D - D (W + D)^-1 D. Subtracting from D keeps accuracy
/// where D is small beside the spring (a light vessel on stiff springs); D is not inverted, as it may be stiff in one
/// direction and nearly zero in another.
VMESH_INLINE void reduce_free(const RodBatch& b, const Lanes3& z, LanesMatrix& d, LanesVector& f) {
  const Lanes3 lever = b.length * z;
  carry(lever, d);
  f = LanesVector(carried(lever, f.spatial()));
  LanesMatrix sum, reduced;
  copy(d, sum);
  copy(d, reduced);
  add_diagonal(sum, b.w_stretch, b.w_bend, b.w_twist, z);
  LanesFactors(sum).subtract_series(d, LanesVector(f.spatial() + b.spring_gradient), reduced, f);
  copy(reduced, d);
}

VMESH_INLINE Lanes3 angular_compliance(const RodBatch& b, const Lanes3& z, const Lanes3& t) {
  return b.c_bend * t + (b.c_twist - b.c_bend) * dot(z, t) * z;
}

/// The torque on a held slot that follows its target without rotating.
VMESH_INLINE Lanes3 torque_on(const Lanes3& prescribed, const LanesMatrix& d, const LanesVector& f) {
  return f.spatial().angular + prescribed.x * mixed_column(d, 0) + prescribed.y * mixed_column(d, 1) +
         prescribed.z * mixed_column(d, 2);
}

/// The same as reduce_free() with the slot's position given, and also its frame if clamped. The inverse of the spring's
/// W as seen from the slot, J^T W J with J x = y, and the rotational compliance of a fixed slot are in series.
VMESH_INLINE void reduce_held(const RodBatch& b, const Lanes3& z, const Lanes3& prescribed, LanesMatrix& d,
                              LanesVector& f) {
  const Lanes3 lever = b.length * z;
  const Lanes sideways = b.c_bend * square(lever);
  LanesMatrix follows{};
  add_diagonal(follows, b.c_stretch + sideways, b.c_bend, b.c_twist, z);
  const Lanes3 axial = sideways * z, bent = b.c_bend * lever;
  follows.entries[at(0, 0)] -= axial.x * z.x;
  follows.entries[at(1, 0)] -= axial.y * z.x;
  follows.entries[at(1, 1)] -= axial.y * z.y;
  follows.entries[at(2, 0)] -= axial.z * z.x;
  follows.entries[at(2, 1)] -= axial.z * z.y;
  follows.entries[at(2, 2)] -= axial.z * z.z;
  const Lanes zero = all(0);
  set_mixed_column(follows, 0, {zero, bent.z, -bent.y});
  set_mixed_column(follows, 1, {-bent.z, zero, bent.x});
  set_mixed_column(follows, 2, {bent.y, -bent.x, zero});

  const LaneMask clamped = holds(b, true);
  const Lanes33 turns = inverse_angular(d);
  const Lanes3 turn = select(clamped, Lanes3{zero, zero, zero}, -product(turns, torque_on(prescribed, d, f)));
  const Lanes3* const columns[]{&turns.x, &turns.y, &turns.z};
  for (std::size_t j = 0; j < 3; ++j) {
    const Lanes column[]{columns[j]->x, columns[j]->y, columns[j]->z};
    for (std::size_t i = j; i < 3; ++i) follows.entries[at(3 + i, 3 + j)] += clamped ? zero : column[i];
  }
  const Lanes3 spring_turn = angular_compliance(b, z, b.spring_gradient.angular);
  const Lanes3 apart = cross(lever, spring_turn) - b.c_stretch * b.spring_gradient.linear - prescribed;
  const LanesFactors factors(follows);
  for (std::size_t j = 0; j < 6; ++j) {
    LanesVector unit(LanesSpatial{{zero, zero, zero}, {zero, zero, zero}});
    unit[j] = all(1);
    const LanesVector column = factors.solve(unit);
    for (std::size_t i = j; i < 6; ++i) d.entries[at(i, j)] = column[i];
  }
  f = LanesVector(carried(lever, factors.solve(LanesVector({apart, -spring_turn - turn})).spatial()));
  carry(lever, d);
}

/// The minimiser, for roots.
VMESH_INLINE LanesSpatial minimum(const RodBatch& b, const Lanes3& prescribed, const LanesMatrix& d,
                                  const LanesVector& f) {
  const LanesVector x = LanesFactors(d).solve(f);
  LanesSpatial r{-x.spatial().linear, -x.spatial().angular};
  if (!b.held) return r;
  const Lanes zero = all(0);
  const Lanes3 turn = -product(inverse_angular(d), torque_on(prescribed, d, f));
  r.linear = select(holds(b, false), prescribed, r.linear);
  r.angular = select(holds(b, false), select(holds(b, true), Lanes3{zero, zero, zero}, turn), r.angular);
  return r;
}

VMESH_INLINE void add_children(const RodBatches& tree, const RodBatch& b, LanesMatrix& d, LanesVector& f) {
  for (Index rank = 0; rank < b.child_ranks; ++rank) {
    const std::array<Index, kLanes>& places = tree.children[b.first_children + rank];
    const double* from[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i)
      from[i] = reinterpret_cast<const double*>(&tree.batches[places[i] / kLanes].reduced) + places[i] % kLanes;
#pragma GCC unroll 21
    for (std::size_t k = 0; k < 21; ++k) {
      Lanes v;
      for (std::size_t i = 0; i < kLanes; ++i) v[i] = from[i][k * kLanes];
      d.entries[k] += v;
    }
#pragma GCC unroll 6
    for (std::size_t k = 0; k < 6; ++k) {
      Lanes v;
      for (std::size_t i = 0; i < kLanes; ++i) v[i] = from[i][(21 + k) * kLanes];
      f[k] += v;
    }
  }
}

/// Adds up the slots' children and their own inertia.
VMESH_INLINE void assemble(const RodBatches& tree, const RodBatch& b, const Lanes3& z, LanesMatrix& d, LanesVector& f) {
  clear(d);
  add_diagonal(d, b.step_mass, b.step_inertia + b.taut, 2 * b.step_inertia, z);
  add_children(tree, b, d, f);
}

/// For batches with held slots or roots: their reduced `d` and `f`, and x of roots.
[[gnu::noinline]] void eliminate_special(const RodBatches& tree, RodBatch& b, std::size_t pose, LaneMask m,
                                         LanesMatrix& d, LanesVector& f) {
  const Lanes3& z = b.pose[pose].frame.z;
  LanesMatrix own;
  LanesVector load(b.gradient);
  assemble(tree, b, z, own, load);
  const Lanes3 prescribed = b.target - b.pose[pose].position;
  const LaneMask root = b.is_root != 0, held = holds(b, false);
  if (b.rooted) b.x = select(m & root, minimum(b, prescribed, own, load), b.x);
  reduce_held(b, z, prescribed, own, load);
  for (std::size_t k = 0; k < 21; ++k) d.entries[k] = held ? own.entries[k] : d.entries[k];
  for (std::size_t k = 0; k < 6; ++k) f[k] = held ? load[k] : f[k];
}

VMESH_INLINE void store(const LanesMatrix& d, const LanesVector& f, LaneMask m, RodBatch& b) {
#pragma GCC unroll 21
  for (std::size_t k = 0; k < 21; ++k) b.reduced.entries[k] = m ? d.entries[k] : b.reduced.entries[k];
  b.reduced_gradient = select(m, f.spatial(), b.reduced_gradient);
}

void eliminate(RodBatches& tree, Index batch, std::size_t pose, const char* active) {
  RodBatch& b = tree.batches[batch];
  const LaneMask m = mask_of(active);
  const Lanes3& z = b.pose[pose].frame.z;
  LanesMatrix d;
  LanesVector f(b.gradient);
  assemble(tree, b, z, d, f);
  reduce_free(b, z, d, f);
  if (b.held || b.rooted) {
    LanesMatrix special;
    copy(d, special);
    LanesVector load = f;
    eliminate_special(tree, b, pose, m, special, load);
    store(special, load, m, b);
  } else {
    store(d, f, m, b);
  }
}

VMESH_INLINE void take(const Lanes3& from, std::size_t lane, Lanes3& to, std::size_t i) {
  to.x[i] = from.x[lane], to.y[i] = from.y[lane], to.z[i] = from.z[lane];
}

VMESH_INLINE LanesSpatial parent_solution(const RodBatches& tree, const RodBatch& b) {
  LanesSpatial x;
#pragma GCC unroll 4
  for (std::size_t i = 0; i < kLanes; ++i) {
    const LanesSpatial& from = tree.batches[b.parent[i] / kLanes].x;
    const std::size_t lane = b.parent[i] % kLanes;
    take(from.linear, lane, x.linear, i), take(from.angular, lane, x.angular, i);
  }
  return x;
}

VMESH_INLINE LanesSpatial solution(const RodBatch& b, const Lanes3& z, const LanesSpatial& at_parent) {
  LanesVector pull(b.spring_gradient + b.reduced_gradient), parent(at_parent);
#pragma GCC unroll 6
  for (std::size_t i = 0; i < 6; ++i)
#pragma GCC unroll 6
    for (std::size_t j = 0; j < 6; ++j) pull[j] += parent[i] * b.reduced.entries[at(i, j)];
  LanesSpatial x;
  const Lanes3 lever = b.length * z;
  x.angular = at_parent.angular - angular_compliance(b, z, pull.spatial().angular);
  x.linear = at_parent.linear - b.c_stretch * pull.spatial().linear - cross(lever, x.angular);
  return x;
}

void substitute(RodBatches& tree, Index batch, std::size_t pose, const char* active, const char* rests,
                double tolerance) {
  RodBatch& b = tree.batches[batch];
  const LaneMask m = mask_of(active);
  const Lanes zero = all(0);
  LanesSpatial x = solution(b, b.pose[pose].frame.z, parent_solution(tree, b));
  if (b.rooted) x = select(b.is_root != 0, b.x, x);
  if (b.held) {
    x.linear = select(holds(b, false), b.target - b.pose[pose].position, x.linear);
    x.angular = select(holds(b, true), Lanes3{zero, zero, zero}, x.angular);
  }
  const Lanes linear = square(x.linear), angular = square(x.angular), reach = tolerance * b.radius;
  const Lanes finite = zero * (linear + angular);
  const LaneMask near = (linear <= reach * reach) & (angular <= all(tolerance * tolerance)) & mask_of(rests);
  const LaneMask stays = near | (finite != 0);
  x = select(stays, LanesSpatial{{zero, zero, zero}, {zero, zero, zero}}, x);
  b.x = select(m, x, b.x);
}

struct ParentPose {
  Lanes3 position, turned;
  Lanes33 frame;
};

VMESH_INLINE ParentPose parent_pose(const RodBatches& tree, const RodBatch& b, std::size_t pose) {
  ParentPose r;
#pragma GCC unroll 4
  for (std::size_t i = 0; i < kLanes; ++i) {
    const LanesPose& from = tree.batches[b.parent[i] / kLanes].pose[pose];
    const std::size_t lane = b.parent[i] % kLanes;
    take(from.position, lane, r.position, i), take(from.turned, lane, r.turned, i);
    take(from.frame.x, lane, r.frame.x, i), take(from.frame.y, lane, r.frame.y, i);
    take(from.frame.z, lane, r.frame.z, i);
  }
  return r;
}

/// Twice the energy of the springs, elastic and damping: against stretch and against rotation relative to the parent
/// since the start of the step, not against rotation as a whole.
VMESH_INLINE Lanes evaluate_springs(RodBatch& b, const LanesPose& pose, const ParentPose& parent, LaneMask m) {
  const Lanes33 wanted = product(parent.frame, b.turn);
  const auto& [x, y, z] = pose.frame;
  LanesSpatial gradient;
  gradient.linear = b.stretch * pose.misfit;
  const Lanes pulled = dot(pose.misfit, z), zero = all(0), most = kMostTautness * b.length;
  const Lanes strained = pulled < 0 ? zero : (pulled > most ? most : pulled);
  gradient.angular = -b.tip_xy * (cross(x, wanted.x) + cross(y, wanted.y)) - b.tip_z * cross(z, wanted.z);
  const Lanes elastic =
      0.5 * (b.stretch * square(pose.misfit) + b.tip_xy * (square(wanted.x - x) + square(wanted.y - y)) +
             b.tip_z * square(wanted.z - z));
  b.taut = m ? b.length * b.stretch * strained : b.taut;
  b.elastic = m ? elastic : b.elastic;
  b.elastic_gradient = select(m, gradient, b.elastic_gradient);

  const Lanes3 stretched = pose.misfit - b.pose[0].misfit, &z0 = b.pose[0].frame.z;
  const Lanes3 pull = b.damping_rate * b.stretch * stretched, turn = pose.turned - parent.turned;
  const Lanes3 torque = b.damping_rate * ((b.tip_xy + b.tip_z) * turn + (b.tip_xy - b.tip_z) * dot(z0, turn) * z0);
  gradient.linear = gradient.linear + pull;
  gradient.angular = gradient.angular + torque;
  b.spring_gradient = select(m, gradient, b.spring_gradient);
  return elastic + 0.5 * (dot(pull, stretched) + dot(turn, torque));
}

void move(RodBatches& tree, Index batch, const char* active, const RodMove& by, MoveSums& sums) {
  RodBatch& b = tree.batches[batch];
  const LaneMask m = mask_of(active);
  const LanesPose& from = b.pose[by.from];
  const ParentPose parent = parent_pose(tree, b, by.to);
  const Lanes part = all(by.part), zero = all(0);
  LanesPose to;
  const Lanes3 angle = part * b.x.angular;
  to.frame = product(cayley(angle), from.frame);
  to.turned = from.turned + angle;
  if (b.held) {
    to.frame = select(holds(b, true), from.frame, to.frame);
    to.turned = select(holds(b, true), from.turned, to.turned);
  }
  to.position = from.position + part * b.x.linear;
  if (by.chained) {
    // The solution's change of the segment relative to its axis, linearised: without the lengthening by finite
    // rotations.
    const Lanes3 change = b.x.linear + b.length * cross(from.frame.z, b.x.angular) - parent_solution(tree, b).linear;
    const Lanes3 hung = parent.position + b.length * to.frame.z + from.misfit + part * change;
    const LaneMask straight = (square(b.x.linear) == 0) | (b.is_root != 0);
    to.position = select(straight, to.position, hung);
  }
  if (b.held) to.position = select(holds(b, false), b.target, to.position);
  to.misfit = to.position - parent.position - b.length * to.frame.z;
  if (b.rooted) to.misfit = select(b.is_root != 0, Lanes3{zero, zero, zero}, to.misfit);
  const LanesPose& old = b.pose[by.to];
  const LanesPose kept{select(m, to.position, old.position), select(m, to.frame, old.frame),
                       select(m, to.turned, old.turned), select(m, to.misfit, old.misfit)};
  b.pose[by.to] = kept;
  const Lanes value = 0.5 * evaluate_inertia(b, kept, m) + evaluate_springs(b, kept, parent, m);
  sums.value += m ? value : zero;
  sums.largest = larger(sums.largest, m ? square(b.x.linear) : zero);
}

/// Work on a held lane by what drags it, uJ.
VMESH_INLINE double work_of_hand(const RodBatches& tree, const RodBatch& b, std::size_t lane, const Vec3& moved,
                                 const Vec3& faster, double step_s) {
  const auto pull = [](const RodBatch& from, std::size_t i) -> Vec3 {
    const Lanes3& g = from.spring_gradient.linear;
    return {g.x[i], g.y[i], g.z[i]};
  };
  Vec3 hand = b.mass[lane] / step_s * faster + pull(b, lane);
  for (Index rank = 0; rank < b.child_ranks; ++rank) {
    const Index c = tree.children[b.first_children + rank][lane];
    hand -= pull(tree.batches[c / kLanes], c % kLanes);
  }
  return hand.dot(moved);
}

VMESH_INLINE void write(const Lanes3& from, std::size_t lane, double* to) {
  to[0] = from.x[lane], to[1] = from.y[lane], to[2] = from.z[lane];
}

void finish(RodBatches& tree, Index batch, const char* active, const RodFinish& by, RodScene& scene, FinishSums& sums) {
  RodBatch& b = tree.batches[batch];
  const LaneMask m = mask_of(active);
  const Lanes zero = all(0);
  const double step = scene.options.step_s, tolerance = scene.options.rest_tolerance;
  LanesPose& start = b.pose[0];
  LanesPose end = b.pose[by.pose];
  if (by.sharpens) end.frame = sharpened(end.frame);
  const Lanes3 moved = end.position - start.position, turned = turned_by(start.frame, end.frame);
  const Lanes3 velocity = all(1 / step) * moved, spin = all(1 / step) * turned;
  const Lanes axial = dot(spin, end.frame.z);
  const Lanes spinning = 0.5 * b.inertia * (square(spin) + axial * axial), moving = 0.5 * b.mass * square(velocity);
  const Vec3& g = scene.options.gravity_mm_s2;
  const Lanes3 load = read(scene.force, b) + b.mass * Lanes3{all(g.x()), all(g.y()), all(g.z())};
  const Lanes turning = dot(read(scene.torque, b), turned);
  Lanes free = spinning + moving, held = zero, work = turning + dot(load, moved);
  if (b.held) {
    const LaneMask holding = holds(b, false);
    free = holding ? spinning : free, held = holding ? moving : zero;
    for (std::size_t i = 0; i < kLanes; ++i) {
      if (!active[i] || b.hold[i] == Hold::free) continue;
      const Vec3 way{moved.x[i], moved.y[i], moved.z[i]}, faster{velocity.x[i], velocity.y[i], velocity.z[i]};
      const double hand =
          way == Vec3::Zero() ? 0 : work_of_hand(tree, b, i, way, faster - scene.velocity[b.slot[i]], step);
      work[i] = turning[i] + hand;
    }
  }
  sums.work += m ? work : zero, sums.elastic += m ? b.elastic : zero;
  sums.free += m ? free : zero, sums.held += m ? held : zero;

  const Lanes far = square(moved), wide = square(turned), reach = tolerance * b.radius;
  const LaneMask hardly = (far <= reach * reach) & (wide <= all(tolerance * tolerance));
  const LaneMask still = (far == 0) & (wide == 0);
  start.position = select(m, end.position, start.position);
  start.frame = select(m, end.frame, start.frame);
  start.misfit = select(m, end.misfit, start.misfit);
#pragma GCC unroll 4
  for (std::size_t i = 0; i < kLanes; ++i) {
    if (!active[i]) continue;
    const Index j = b.slot[i];
    by.quiet[i] = hardly[i] != 0;
    if (!still[i]) scene.moved[j] = 1;
    write(start.position, i, scene.pose.position[j].data());
    write(start.frame.x, i, scene.pose.frame[j].data());
    write(start.frame.y, i, scene.pose.frame[j].data() + 3);
    write(start.frame.z, i, scene.pose.frame[j].data() + 6);
    write(velocity, i, scene.velocity[j].data());
    write(spin, i, scene.spin[j].data());
  }
}

}  // namespace

const RodKernels kRodKernels{begin, eliminate, substitute, move, finish};

}  // namespace vmesh::VMESH_INSTRUCTION_SET

#include "deform/rod_equations.h"

namespace vmesh {
namespace {

inline Vec3 angular_compliance(const RodEquation& e, const Vec3& t) {
  return e.bend_compliance * t + (e.twist_compliance - e.bend_compliance) * e.z.dot(t) * e.z;
}

/// The inverse of the spring's W seen from the slot, J^T W J with J x = y.
Matrix6 compliance(const RodEquation& e) {
  const double bend = e.bend_compliance, sideways = bend * e.lever.squaredNorm();
  Matrix6 c;
  for (int i = 0; i < 3; ++i) {
    const Vec3 unit = Vec3::Unit(i), axial = e.z[i] * e.z, turned = bend * e.lever.cross(unit);
    c[i] = {(e.stretch_compliance + sideways) * unit - sideways * axial, turned};
    c[3 + i] = {-turned, bend * unit + (e.twist_compliance - bend) * axial};
  }
  return c;
}

/// `linear` against moving; against turning `axial` about z and `transverse` across it.
[[gnu::always_inline]] inline Matrix6 diagonal(double linear, double transverse, double axial, const Vec3& z) {
  Matrix6 m;
  for (int i = 0; i < 3; ++i) {
    m[i] = {linear * Vec3::Unit(i), Vec3::Zero()};
    m[3 + i] = {Vec3::Zero(), transverse * Vec3::Unit(i) + (axial - transverse) * z[i] * z};
  }
  return m;
}

/// D and b in series with the spring, seen from the parent: D - D (W + D)^-1 D. Subtracts from D, which is what matters
/// when it is small beside the spring: a light vessel on stiff springs; D is not inverted, as it may be stiff one way
/// and next to nothing another.
[[gnu::always_inline]] inline void reduce_free(RodEquation& e, Matrix6& d, Vector6& b) {
  carry(e.lever, d);
  b = Carried(e.lever)(b);
  Matrix6 sum = diagonal(e.stretch, e.bend, e.twist, e.z);
  sum += d;
  copy(d, e.reduced);
  e.reduced_gradient = b;
  Factors6(sum).subtract_series(d, b + Vector6(e.spring_gradient), e.reduced, e.reduced_gradient);
}

/// The torque on a held slot that goes where it is told without turning.
Vec3 torque_on(const RodEquation& e, const Matrix6& d, const Vector6& b) {
  Vec3 torque = b.angular();
  for (int i = 0; i < 3; ++i) torque += e.prescribed[i] * d[i].angular();
  return torque;
}

/// The same with the slot's position given, and its frame too when clamped.
void reduce_held(RodEquation& e, const Matrix6& d, const Vector6& b) {
  Matrix6 follows = compliance(e);
  Vec3 turn = Vec3::Zero();
  if (e.hold == Hold::fixed) {
    const Mat3 turns = inverse(d.angular());
    turn = -(turns * torque_on(e, d, b));
    for (int i = 0; i < 3; ++i) follows[3 + i] += Vector6(Vec3::Zero(), turns.col(i));
  }
  const Vec3 spring_turn = angular_compliance(e, e.spring_gradient.angular);
  const Vec3 apart = e.lever.cross(spring_turn) - e.stretch_compliance * e.spring_gradient.linear - e.prescribed;
  const Factors6 factors(follows);
  for (int i = 0; i < 3; ++i) {
    e.reduced[i] = factors.solve({Vec3::Unit(i), Vec3::Zero()});
    e.reduced[3 + i] = factors.solve({Vec3::Zero(), Vec3::Unit(i)});
  }
  e.reduced.mirror();
  e.reduced_gradient = Carried(e.lever)(factors.solve({apart, -spring_turn - turn}));
  carry(e.lever, e.reduced);
}

Spatial minimum(const Matrix6& d, const Vector6& b, const RodEquation& e) {
  if (e.hold == Hold::clamped) return {e.prescribed, Vec3::Zero()};
  if (e.hold == Hold::fixed) return {e.prescribed, -(inverse(d.angular()) * torque_on(e, d, b))};
  const Vector6 x = Factors6(d).solve({-b.linear(), -b.angular()});
  return {x.linear(), x.angular()};
}

}  // namespace

void eliminate(std::vector<RodEquation>& equations, const std::vector<Rod>& rods, Index j) {
  RodEquation& e = equations[j];
  Matrix6 d = diagonal(e.mass, e.inertia + e.taut, 2 * e.inertia, e.z);
  Vector6 b(e.gradient);
  for (Index c = rods[j].first_child; c != kNone; c = rods[c].next_sibling) {
    d += equations[c].reduced;
    b += equations[c].reduced_gradient;
  }
  if (rods[j].parent == kNone)
    e.x = minimum(d, b, e);
  else if (e.hold == Hold::free)
    reduce_free(e, d, b);
  else
    reduce_held(e, d, b);
}

void substitute(std::vector<RodEquation>& equations, Index j, Index parent) {
  RodEquation& e = equations[j];
  const Spatial& at_parent = equations[parent].x;
  Vector6 pull = Vector6(e.spring_gradient) + e.reduced_gradient;
  for (int i = 0; i < 3; ++i) {
    add(pull, at_parent.linear[i], e.reduced[i]);
    add(pull, at_parent.angular[i], e.reduced[3 + i]);
  }
  e.x.angular = at_parent.angular - angular_compliance(e, pull.angular());
  e.x.linear = at_parent.linear - e.stretch_compliance * pull.linear() - e.lever.cross(e.x.angular);
  if (e.hold != Hold::free) e.x.linear = e.prescribed;
  if (e.hold == Hold::clamped) e.x.angular.setZero();
}

}  // namespace vmesh

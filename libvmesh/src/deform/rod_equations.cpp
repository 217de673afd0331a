#include "deform/rod_equations.h"

namespace vmesh {
namespace {

inline Vec3 angular_compliance(const RodEquation& e, const Vec3& t) {
  return e.bend_compliance * t + (e.twist_compliance - e.bend_compliance) * e.z.dot(t) * e.z;
}

/// The spring's W seen from the slot: J^T W J, with J x = y.
SpatialMatrix stiffness(const RodEquation& e) {
  const double sideways = e.stretch * e.lever.squaredNorm();
  SpatialMatrix w;
  w.ll.diagonal().setConstant(e.stretch);
  w.la = cross_columns(e.stretch * e.lever, Mat3::Identity());
  w.aa = (e.twist - e.bend - sideways) * e.z * e.z.transpose();
  w.aa.diagonal().array() += e.bend + sideways;
  return w;
}

/// The inverse of that.
SpatialMatrix compliance(const RodEquation& e) {
  const double bend = e.bend_compliance, sideways = bend * e.lever.squaredNorm();
  const Mat3 zz = e.z * e.z.transpose();
  SpatialMatrix c;
  c.ll = -sideways * zz;
  c.ll.diagonal().array() += e.stretch_compliance + sideways;
  c.la = cross_columns(-bend * e.lever, Mat3::Identity());
  c.aa = (e.twist_compliance - bend) * zz;
  c.aa.diagonal().array() += bend;
  return c;
}

/// What a slot means to its parent, but seen from the slot.
struct Reduced {
  SpatialMatrix stiffness;
  Spatial gradient;
};

/// D and b in series with the spring: D - D (W + D)^-1 D by block elimination. Subtracts from D, which is what matters
/// when it is small beside the spring: a light vessel on stiff springs; D is not inverted, as it may be stiff one way
/// and next to nothing another.
Reduced reduce_free(const RodEquation& e, const SpatialMatrix& d, const Spatial& b) {
  SpatialMatrix sum = stiffness(e);
  sum += d;
  const Mat3 first = inverse(sum.ll);
  const Mat3 u = product(first, sum.la);
  const Mat3 second = inverse(raised(sum.aa - transposed_product(sum.la, u), sum.aa));
  const Mat3 lower_l = transposed(d.la) - transposed_product(u, d.ll), lower_a = d.aa - transposed_product(u, d.la);
  const Mat3 first_l = product(first, d.ll), first_a = product(first, d.la);
  const Mat3 second_l = product(second, lower_l), second_a = product(second, lower_a);
  Reduced r;
  r.stiffness.ll = d.ll - product(d.ll, first_l) - transposed_product(lower_l, second_l);
  r.stiffness.la = d.la - product(d.ll, first_a) - transposed_product(lower_l, second_a);
  r.stiffness.aa = d.aa - transposed_product(d.la, first_a) - transposed_product(lower_a, second_a);
  const Spatial& f = e.spring_gradient;
  const Vec3 all_l = b.linear + f.linear, all_a = b.angular + f.angular - e.lever.cross(f.linear);
  const Vec3 lower = all_a - times_transposed(u, all_l);
  r.gradient = {b.linear - times_transposed(first_l, all_l) - times_transposed(second_l, lower),
                b.angular - times_transposed(first_a, all_l) - times_transposed(second_a, lower)};
  return r;
}

/// The same with the slot's position given, and its frame too when clamped.
Reduced reduce_held(const RodEquation& e, const SpatialMatrix& d, const Spatial& b) {
  SpatialMatrix follows = compliance(e);
  Vec3 turn = Vec3::Zero();
  if (e.hold == Hold::fixed) {
    const Mat3 turns = inverse(d.aa);
    turn = -(turns * (b.angular + d.la.transpose() * e.prescribed));
    follows.aa += turns;
  }
  Reduced r;
  r.stiffness = inverse(follows);
  const Vec3 spring_turn = angular_compliance(e, e.spring_gradient.angular);
  r.gradient =
      r.stiffness * Spatial{e.lever.cross(spring_turn) - e.stretch_compliance * e.spring_gradient.linear - e.prescribed,
                            -spring_turn - turn};
  return r;
}

/// J^-T m J^-1 and J^-T f: seen from the parent.
void set_reduced(RodEquation& e, const Reduced& r) {
  const auto& [m, f] = r;
  e.reduced.ll = m.ll;
  e.reduced.la = m.la + cross_columns(e.lever, m.ll).transpose();
  e.reduced.aa = m.aa + cross_columns(e.lever, e.reduced.la) + cross_columns(e.lever, m.la).transpose();
  e.reduced_gradient = {f.linear, f.angular + e.lever.cross(f.linear)};
}

Spatial minimum(const SpatialMatrix& d, const Spatial& b, const RodEquation& e) {
  if (e.hold == Hold::clamped) return {e.prescribed, Vec3::Zero()};
  if (e.hold == Hold::free) return inverse(d) * Spatial{-b.linear, -b.angular};
  return {e.prescribed, -(inverse(d.aa) * (b.angular + d.la.transpose() * e.prescribed))};
}

}  // namespace

void eliminate(std::vector<RodEquation>& equations, const std::vector<Rod>& rods, Index j) {
  RodEquation& e = equations[j];
  SpatialMatrix d;
  d.ll.diagonal().setConstant(e.mass);
  d.aa = (e.inertia - e.taut) * e.z * e.z.transpose();
  d.aa.diagonal().array() += e.inertia + e.taut;
  Spatial b = e.gradient;
  for (Index c = rods[j].first_child; c != kNone; c = rods[c].next_sibling) {
    d += equations[c].reduced;
    b = b + equations[c].reduced_gradient;
  }
  if (rods[j].parent == kNone)
    e.x = minimum(d, b, e);
  else
    set_reduced(e, e.hold == Hold::free ? reduce_free(e, d, b) : reduce_held(e, d, b));
}

void substitute(std::vector<RodEquation>& equations, Index j, Index parent) {
  RodEquation& e = equations[j];
  const Spatial& at_parent = equations[parent].x;
  const Spatial pull = e.spring_gradient + e.reduced_gradient + e.reduced * at_parent;
  e.x.angular = at_parent.angular - angular_compliance(e, pull.angular);
  e.x.linear = at_parent.linear - e.stretch_compliance * pull.linear - e.lever.cross(e.x.angular);
  if (e.hold != Hold::free) e.x.linear = e.prescribed;
  if (e.hold == Hold::clamped) e.x.angular.setZero();
}

}  // namespace vmesh

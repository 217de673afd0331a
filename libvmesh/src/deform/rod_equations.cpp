#include "deform/rod_equations.h"

namespace vmesh {
namespace {

/// Minimises 1/2 u^T D u + b u under the hold; `inverse` is how u follows a force.
struct HeldMinimum {
  SpatialMatrix inverse;
  Spatial u;
};

HeldMinimum held_minimum(const SpatialMatrix& d, const Spatial& b, Hold hold, const Vec3& prescribed) {
  HeldMinimum m;
  if (hold == Hold::free) {
    m.inverse = inverse(d);
    m.u = m.inverse * Spatial{-b.linear, -b.angular};
    return m;
  }
  m.u.linear = prescribed;
  if (hold == Hold::fixed) {
    m.inverse.aa = inverse(d.aa);
    m.u.angular = -(m.inverse.aa * (b.angular + d.la.transpose() * prescribed));
  }
  return m;
}

Vec3 angular_compliance(const RodEquation& e, const Vec3& t) {
  return e.bend_compliance * t + (e.twist_compliance - e.bend_compliance) * e.z.dot(t) * e.z;
}

/// W^-1 + J D^-1 J^T, with J x = y.
SpatialMatrix compliance(const RodEquation& e, const SpatialMatrix& inverse) {
  SpatialMatrix c;
  c.aa = inverse.aa;
  c.la = inverse.la + cross_columns(e.lever, inverse.aa);
  c.ll = inverse.ll + cross_columns(e.lever, inverse.la.transpose()) +
         cross_columns(e.lever, c.la.transpose()).transpose();
  c.ll.diagonal().array() += e.stretch_compliance;
  c.aa.diagonal().array() += e.bend_compliance;
  c.aa += (e.twist_compliance - e.bend_compliance) * e.z * e.z.transpose();
  return c;
}

}  // namespace

void eliminate(std::vector<RodEquation>& equations, const std::vector<Rod>& rods, Index j) {
  RodEquation& e = equations[j];
  SpatialMatrix d;
  d.ll.diagonal().setConstant(e.mass);
  d.aa = e.inertia * e.z * e.z.transpose();
  d.aa.diagonal().array() += e.inertia;
  Spatial b = e.gradient;
  for (Index c = rods[j].first_child; c != kNone; c = rods[c].next_sibling) {
    d += equations[c].reduced;
    b = b + equations[c].reduced_gradient;
  }
  const HeldMinimum minimum = held_minimum(d, b, e.hold, e.prescribed);
  e.x = minimum.u;
  if (rods[j].parent == kNone) return;
  e.reduced = inverse(compliance(e, minimum.inverse));
  const Spatial& f = e.spring_gradient;
  const Spatial& u = minimum.u;
  const Spatial g = e.reduced * Spatial{e.stretch_compliance * f.linear + u.linear + e.lever.cross(u.angular),
                                        angular_compliance(e, f.angular) + u.angular};
  e.reduced_gradient = {-g.linear, -g.angular};
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

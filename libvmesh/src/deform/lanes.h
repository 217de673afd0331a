// Arithmetic on lanes, for sources that are compiled once for every instruction set.
#pragma once

#include "deform/rod_batch.h"

namespace vmesh::VMESH_INSTRUCTION_SET {
namespace {

using LaneMask = decltype(Lanes{} < Lanes{});  ///< all bits of a lane, or none

#define VMESH_INLINE [[gnu::always_inline]] inline

VMESH_INLINE Lanes all(double value) {
  Lanes r;
  for (std::size_t i = 0; i < kLanes; ++i) r[i] = value;
  return r;
}
VMESH_INLINE Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }

VMESH_INLINE Lanes3 operator+(const Lanes3& a, const Lanes3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
VMESH_INLINE Lanes3 operator-(const Lanes3& a, const Lanes3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
VMESH_INLINE Lanes3 operator-(const Lanes3& a) { return {-a.x, -a.y, -a.z}; }
VMESH_INLINE Lanes3 operator*(Lanes f, const Lanes3& a) { return {f * a.x, f * a.y, f * a.z}; }
VMESH_INLINE Lanes dot(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
VMESH_INLINE Lanes square(const Lanes3& a) { return dot(a, a); }
VMESH_INLINE Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
VMESH_INLINE Lanes3 select(LaneMask m, const Lanes3& a, const Lanes3& b) {
  return {m ? a.x : b.x, m ? a.y : b.y, m ? a.z : b.z};
}
VMESH_INLINE Lanes33 select(LaneMask m, const Lanes33& a, const Lanes33& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
VMESH_INLINE LanesSpatial select(LaneMask m, const LanesSpatial& a, const LanesSpatial& b) {
  return {select(m, a.linear, b.linear), select(m, a.angular, b.angular)};
}
VMESH_INLINE Lanes3 product(const Lanes33& m, const Lanes3& v) { return v.x * m.x + v.y * m.y + v.z * m.z; }
VMESH_INLINE Lanes33 product(const Lanes33& a, const Lanes33& b) {
  return {product(a, b.x), product(a, b.y), product(a, b.z)};
}

/// The rotation I + [v]x + ... by Cayley's map: exactly orthogonal, and by |v| for a short v.
VMESH_INLINE Lanes33 cayley(const Lanes3& v) {
  const Lanes3 w = 0.5 * all(1) * v;
  const Lanes ww = square(w), f = 2 / (1 + ww), d = 1 - f * ww;
  const Lanes3 s = f * w;
  const Lanes xy = s.x * w.y, yz = s.y * w.z, zx = s.z * w.x;
  return {
      {d + s.x * w.x, xy + s.z, zx - s.y}, {xy - s.z, d + s.y * w.y, yz + s.x}, {zx + s.y, yz - s.x, d + s.z * w.z}};
}

/// Removes rounding errors from nearly orthonormal frames.
VMESH_INLINE Lanes33 sharpened(const Lanes33& m) {
  const Lanes xx = square(m.x), yy = square(m.y), zz = square(m.z);
  const Lanes xy = dot(m.x, m.y), yz = dot(m.y, m.z), zx = dot(m.z, m.x);
  const Lanes33 gram{{xx, xy, zx}, {xy, yy, yz}, {zx, yz, zz}};
  const Lanes33 p = product(m, gram);
  const Lanes half = all(0.5), more = all(1.5);
  return {more * m.x - half * p.x, more * m.y - half * p.y, more * m.z - half * p.z};
}

/// Axis times sine of the rotation from frame `a` to frame `b`.
VMESH_INLINE Lanes3 turned_by(const Lanes33& a, const Lanes33& b) {
  return all(0.5) * (cross(a.x, b.x) + cross(a.y, b.y) + cross(a.z, b.z));
}

VMESH_INLINE double sum(Lanes a) {
  double s = 0;
  for (std::size_t i = 0; i < kLanes; ++i) s += a[i];
  return s;
}
VMESH_INLINE bool any(LaneMask m) {
  long long bits = 0;
  for (std::size_t i = 0; i < kLanes; ++i) bits |= m[i];
  return bits != 0;
}
VMESH_INLINE LaneMask mask_of(const char* flags) {
  LaneMask m;
  for (std::size_t i = 0; i < kLanes; ++i) m[i] = flags[i] ? -1 : 0;
  return m;
}

}  // namespace
}  // namespace vmesh::VMESH_INSTRUCTION_SET

// Compiled once for every instruction set.
#include "deform/synchronise.h"

#include <cmath>

namespace vmesh::VMESH_INSTRUCTION_SET {
namespace {

#define VMESH_INLINE [[gnu::always_inline]] inline

constexpr std::size_t kLanes = SurfaceBinding::kLanes;
using Eight = float __attribute__((vector_size(kLanes * sizeof(float))));
using Four = float __attribute__((vector_size(4 * sizeof(float))));
using FourDoubles = double __attribute__((vector_size(4 * sizeof(double))));
/// At any address; a type that is only declared to be aligned less is taken by clang as aligned.
template <class Vector>
struct [[gnu::packed, gnu::may_alias]] Anywhere {
  Vector value;
};

VMESH_INLINE Eight load(const float* from) { return reinterpret_cast<const Anywhere<Eight>*>(from)->value; }
VMESH_INLINE void store(Eight v, float* to) { reinterpret_cast<Anywhere<Eight>*>(to)->value = v; }
VMESH_INLINE FourDoubles load4(const double* from) {
  return reinterpret_cast<const Anywhere<FourDoubles>*>(from)->value;
}
VMESH_INLINE Eight root(Eight v) {
  for (std::size_t i = 0; i < kLanes; ++i) v[i] = std::sqrt(v[i]);
  return v;
}

struct Eight3 {
  Eight x, y, z;
};
/// Columns.
struct Eight33 {
  Eight3 x, y, z;
};

VMESH_INLINE Eight3 product(const Eight33& m, const Eight3& v) {
  return {m.x.x * v.x + m.y.x * v.y + m.z.x * v.z, m.x.y * v.x + m.y.y * v.y + m.z.y * v.z,
          m.x.z * v.x + m.y.z * v.y + m.z.z * v.z};
}

/// Four numbers of each of eight slots, from rows to columns.
struct Columns {
  Eight a, b, c, d;
};
VMESH_INLINE Columns transposed(const Four (&rows)[kLanes]) {
  Four low[2][4];
  for (std::size_t half = 0; half < 2; ++half) {
    const Four* r = rows + 4 * half;
    const Four p = __builtin_shufflevector(r[0], r[1], 0, 4, 1, 5), q = __builtin_shufflevector(r[2], r[3], 0, 4, 1, 5);
    const Four s = __builtin_shufflevector(r[0], r[1], 2, 6, 3, 7), t = __builtin_shufflevector(r[2], r[3], 2, 6, 3, 7);
    low[half][0] = __builtin_shufflevector(p, q, 0, 1, 4, 5), low[half][1] = __builtin_shufflevector(p, q, 2, 3, 6, 7);
    low[half][2] = __builtin_shufflevector(s, t, 0, 1, 4, 5), low[half][3] = __builtin_shufflevector(s, t, 2, 3, 6, 7);
  }
  return {__builtin_shufflevector(low[0][0], low[1][0], 0, 1, 2, 3, 4, 5, 6, 7),
          __builtin_shufflevector(low[0][1], low[1][1], 0, 1, 2, 3, 4, 5, 6, 7),
          __builtin_shufflevector(low[0][2], low[1][2], 0, 1, 2, 3, 4, 5, 6, 7),
          __builtin_shufflevector(low[0][3], low[1][3], 0, 1, 2, 3, 4, 5, 6, 7)};
}

/// Positions and frames of eight slots.
struct EightPoses {
  Eight3 position;  // relative to the origin
  Eight33 frame;
};
VMESH_INLINE EightPoses poses(const Pose& pose, const std::array<Index, kLanes>& slots, const Vec3& origin) {
  const FourDoubles shift{origin[0], origin[1], origin[2], 0};
  Four first[kLanes], middle[kLanes], last[kLanes];
#pragma GCC unroll 8
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double *frame = pose.frame[slots[i]].data(), *p = pose.position[slots[i]].data();
    first[i] = __builtin_convertvector(load4(frame), Four);
    middle[i] = __builtin_convertvector(load4(frame + 4), Four);
    last[i] = __builtin_convertvector((FourDoubles{p[0], p[1], p[2], frame[8]} - shift), Four);
  }
  const Columns a = transposed(first), b = transposed(middle), c = transposed(last);
  return {{c.a, c.b, c.c}, {{a.a, a.b, a.c}, {a.d, b.a, b.b}, {b.c, b.d, c.d}}};
}

/// (C_j + C_parent Q_j) / 2.
VMESH_INLINE Eight33 mean_frame(const Eight33& own, const Eight33& parent, const float* turn) {
  const auto column = [&](const Eight3& from, const float* q) -> Eight3 {
    const Eight3 other = product(parent, {load(q), load(q + kLanes), load(q + 2 * kLanes)});
    return {0.5f * (from.x + other.x), 0.5f * (from.y + other.y), 0.5f * (from.z + other.z)};
  };
  return {column(own.x, turn), column(own.y, turn + 3 * kLanes), column(own.z, turn + 6 * kLanes)};
}

/// The data that carry the vertices of eight slots.
struct Carrier {
  Eight3 p, d;  // the parents' positions, and from there to the slots'
  Eight33 m;
  Eight scale, scale_change;  // of the profile, likewise
};

VMESH_INLINE Carrier carrier_of(const SurfaceBinding::Group& group, const Pose& pose, const Vec3& origin, bool scaled) {
  const EightPoses own = poses(pose, group.slot, origin), parent = poses(pose, group.parent, origin);
  const Eight3 &p = parent.position, &q = own.position;
  Carrier c{p, {q.x - p.x, q.y - p.y, q.z - p.z}, mean_frame(own.frame, parent.frame, group.turn.data()), {}, {}};
  for (std::size_t i = 0; scaled && i < kLanes; ++i) {
    const double at_parent = pose.radial_scale[group.parent[i]];
    c.scale[i] = static_cast<float>(at_parent);
    c.scale_change[i] = static_cast<float>(pose.radial_scale[group.slot[i]] - at_parent);
  }
  return c;
}

VMESH_INLINE Eight3 position(const SurfaceBinding::Rest& rest, const Carrier& c, std::size_t lane, bool scaled) {
  const Eight t = load(&rest.t[lane]);
  Eight3 v = product(c.m, {load(&rest.x[lane]), load(&rest.y[lane]), load(&rest.z[lane])});
  if (scaled) {
    const Eight scale = c.scale + t * c.scale_change;
    v = {scale * v.x, scale * v.y, scale * v.z};
  }
  return {c.p.x + t * c.d.x + v.x, c.p.y + t * c.d.y + v.y, c.p.z + t * c.d.z + v.z};
}

VMESH_INLINE Eight3 normal(const SurfaceBinding::Rest& rest, const Carrier& c, std::size_t lane) {
  const Eight3 v = product(c.m, {load(&rest.normal_x[lane]), load(&rest.normal_y[lane]), load(&rest.normal_z[lane])});
  // The mean of two rotations shortens vectors; the small number keeps a zero normal zero.
  const Eight f = 1 / root(v.x * v.x + v.y * v.y + v.z * v.z + 1e-30f);
  return {f * v.x, f * v.y, f * v.z};
}

using EightFlags = decltype(Eight{} < Eight{});

/// Writes eight lanes of an array, only those that move.
VMESH_INLINE void write(Eight v, const EightFlags& moving, bool all_move, float* to) {
  store(all_move ? v : (moving ? v : load(to)), to);
}

VMESH_INLINE bool moves(const Attachment& a, const SurfaceBinding::Group& group, std::size_t i) {
  return a.moved.empty() || a.moved[group.slot[i]] || a.moved[group.parent[i]];
}

VMESH_INLINE void carry_group(const Attachment& a, const SurfaceBinding::Group& group, const EightFlags& moving,
                              bool all_move, DeformedSurface& s, bool scaled, bool normals) {
  const Carrier c = carrier_of(group, a.pose, s.origin, scaled);
  for (std::size_t b = group.first_block; b < group.first_block + group.block_count; ++b) {
    const std::size_t lane = b * kLanes;
    const Eight3 p = position(a.rest, c, lane, scaled);
    write(p.x, moving, all_move, &s.x[lane]);
    write(p.y, moving, all_move, &s.y[lane]);
    write(p.z, moving, all_move, &s.z[lane]);
    if (!normals) continue;
    const Eight3 n = normal(a.rest, c, lane);
    write(n.x, moving, all_move, &s.normal_x[lane]);
    write(n.y, moving, all_move, &s.normal_y[lane]);
    write(n.z, moving, all_move, &s.normal_z[lane]);
  }
}

VMESH_INLINE void carry_all(const Attachment& a, DeformedSurface& s, bool scaled, bool normals) {
  for (const SurfaceBinding::Group& group : a.groups) {
    EightFlags moving{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const bool one = moves(a, group, i);
      moving[i] = one ? -1 : 0;
      count += one;
    }
    if (count == kLanes)
      carry_group(a, group, moving, true, s, scaled, normals);
    else if (count > 0)
      carry_group(a, group, moving, false, s, scaled, normals);
  }
}

}  // namespace

void synchronise(const Attachment& attachment, DeformedSurface& surface) noexcept {
  const bool scaled = !attachment.pose.radial_scale.empty(), normals = !surface.normal_x.empty();
  if (scaled)
    normals ? carry_all(attachment, surface, true, true) : carry_all(attachment, surface, true, false);
  else
    normals ? carry_all(attachment, surface, false, true) : carry_all(attachment, surface, false, false);
}

}  // namespace vmesh::VMESH_INSTRUCTION_SET

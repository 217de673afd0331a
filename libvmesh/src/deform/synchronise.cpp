#include "deform/synchronise.h"

#include <cmath>

// One function for each width of the processor's vectors, chosen when the program starts. All do the same operations in
// the same order, so the results are the same. Sanitizers cannot run the code that chooses.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define VMESH_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define VMESH_VECTOR_CLONES
#endif

namespace vmesh {
namespace {

constexpr std::size_t kLanes = SurfaceBinding::kLanes;

/// What all lanes of a run share.
struct Carrier {
  double px, py, pz, dx, dy, dz;  // the parent's position, and from there to the slot's
  double scale, scale_change;     // of the profile, likewise
  float m[9];                     // rows of (C_j + C_parent Q_j) / 2
};

[[gnu::always_inline]] inline Carrier carrier_of(const SurfaceBinding::Run& run, const Pose& pose) {
  const Mat3 &own = pose.frame[run.slot], &parent = pose.frame[run.parent];
  Carrier c;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) {
      const double other = parent(row, 0) * run.turn(0, column) + parent(row, 1) * run.turn(1, column) +
                           parent(row, 2) * run.turn(2, column);
      c.m[3 * row + column] = static_cast<float>(0.5 * (own(row, column) + other));
    }
  const Vec3 &p = pose.position[run.parent], &q = pose.position[run.slot];
  c.px = p.x(), c.py = p.y(), c.pz = p.z();
  c.dx = q.x() - p.x(), c.dy = q.y() - p.y(), c.dz = q.z() - p.z();
  const bool plain = pose.radial_scale.empty();
  c.scale = plain ? 1 : pose.radial_scale[run.parent];
  c.scale_change = plain ? 0 : pose.radial_scale[run.slot] - c.scale;
  return c;
}

/// One block into the lanes from `at`.
template <bool kScaled>
[[gnu::always_inline]] inline void carry(const Carrier& c, const SurfaceBinding::Block& b, std::size_t at,
                                         double* __restrict x, double* __restrict y, double* __restrict z,
                                         float* __restrict nx, float* __restrict ny, float* __restrict nz) {
  float ox[kLanes], oy[kLanes], oz[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) {
    ox[i] = c.m[0] * b.x[i] + c.m[1] * b.y[i] + c.m[2] * b.z[i];
    oy[i] = c.m[3] * b.x[i] + c.m[4] * b.y[i] + c.m[5] * b.z[i];
    oz[i] = c.m[6] * b.x[i] + c.m[7] * b.y[i] + c.m[8] * b.z[i];
  }
  if constexpr (kScaled) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      const float scale = static_cast<float>(c.scale + b.t[i] * c.scale_change);
      ox[i] *= scale, oy[i] *= scale, oz[i] *= scale;
    }
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    x[at + i] = c.px + b.t[i] * c.dx + ox[i];
    y[at + i] = c.py + b.t[i] * c.dy + oy[i];
    z[at + i] = c.pz + b.t[i] * c.dz + oz[i];
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    const float u = c.m[0] * b.normal_x[i] + c.m[1] * b.normal_y[i] + c.m[2] * b.normal_z[i];
    const float v = c.m[3] * b.normal_x[i] + c.m[4] * b.normal_y[i] + c.m[5] * b.normal_z[i];
    const float w = c.m[6] * b.normal_x[i] + c.m[7] * b.normal_y[i] + c.m[8] * b.normal_z[i];
    // The mean of two rotations shortens; smallest: a normal of no length stays so.
    const float f = 1 / std::sqrt(u * u + v * v + w * w + 1e-30f);
    nx[at + i] = f * u;
    ny[at + i] = f * v;
    nz[at + i] = f * w;
  }
}

template <bool kScaled>
[[gnu::always_inline]] inline void carry_all(const Attachment& a, DeformedSurface& out) {
  double *x = out.x.data(), *y = out.y.data(), *z = out.z.data();
  float *nx = out.normal_x.data(), *ny = out.normal_y.data(), *nz = out.normal_z.data();
  for (const SurfaceBinding::Run& run : a.runs) {
    if (!a.moved.empty() && !a.moved[run.slot] && !a.moved[run.parent]) continue;
    const Carrier c = carrier_of(run, a.pose);
    for (std::size_t b = run.first_block; b < run.first_block + run.block_count; ++b)
      carry<kScaled>(c, a.blocks[b], b * kLanes, x, y, z, nx, ny, nz);
  }
}

VMESH_VECTOR_CLONES void carry_plain(const Attachment& a, DeformedSurface& out) { carry_all<false>(a, out); }

VMESH_VECTOR_CLONES void carry_scaled(const Attachment& a, DeformedSurface& out) { carry_all<true>(a, out); }

}  // namespace

void synchronise(const Attachment& attachment, DeformedSurface& surface) noexcept {
  if (attachment.pose.radial_scale.empty())
    carry_plain(attachment, surface);
  else
    carry_scaled(attachment, surface);
}

}  // namespace vmesh

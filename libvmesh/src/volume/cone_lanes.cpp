// Compiled once for every instruction set.
#include "volume/cone_lanes.h"

#include <cmath>

namespace vmesh::VMESH_INSTRUCTION_SET {
namespace {

#define VMESH_INLINE [[gnu::always_inline]] inline

constexpr std::size_t kLanes = ConeLanes::kCount;
constexpr float kNever = 1e30f;  // larger than any distance
using Eight = float __attribute__((vector_size(kLanes * sizeof(float))));
/// At any address; a type that is only declared to be aligned less is taken by clang as aligned.
struct [[gnu::packed, gnu::may_alias]] EightAnywhere {
  Eight value;
};
using EightMask = decltype(Eight{} < Eight{});

VMESH_INLINE Eight load(const float* from) { return reinterpret_cast<const EightAnywhere*>(from)->value; }
VMESH_INLINE Eight load(const ConeLanes::Numbers& from) { return load(from.data()); }
VMESH_INLINE void store(Eight v, float* to) { reinterpret_cast<EightAnywhere*>(to)->value = v; }
VMESH_INLINE Eight all(float v) { return Eight{v, v, v, v, v, v, v, v}; }
VMESH_INLINE Eight smaller(Eight a, Eight b) { return a < b ? a : b; }
VMESH_INLINE Eight root(Eight v) {
  for (std::size_t i = 0; i < kLanes; ++i) v[i] = std::sqrt(v[i]);
  return v;
}
VMESH_INLINE float least_of(Eight v) {
  const Eight a = smaller(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3));
  const Eight b = smaller(a, __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5));
  return b[0] < b[1] ? b[0] : b[1];
}
VMESH_INLINE unsigned bits_of(EightMask m) {
#ifdef __AVX__
  return static_cast<unsigned>(__builtin_ia32_movmskps256(reinterpret_cast<Eight>(m)));
#else
  unsigned bits = 0;
  for (std::size_t i = 0; i < kLanes; ++i) bits |= m[i] ? 1u << i : 0;
  return bits;
#endif
}

/// Of all cones of the query, by number.
struct Distances {
  alignas(32) float value[kMostConeLanes * kLanes], t[kMostConeLanes * kLanes];
  alignas(32) float x[kMostConeLanes * kLanes], y[kMostConeLanes * kLanes], z[kMostConeLanes * kLanes];  // gradients
};

/// Of those that may blend.
struct Candidates {
  static constexpr std::size_t kMost = kMostConeLanes * kLanes;
  std::size_t count = 0;
  alignas(32) float value[kMost], reach[kMost], x[kMost], y[kMost], z[kMost];

  void add(float v, float r, float gx, float gy, float gz) {
    value[count] = v, reach[count] = r, x[count] = gx, y[count] = gy, z[count] = gz;
    ++count;
  }
};

/// The distances from one set of lanes; returns the least.
VMESH_INLINE float measure(const ConeLanes& lanes, const LaneQuery& query, std::size_t first, Distances& to) {
  const Eight x = query.x - load(lanes.origin_x), y = query.y - load(lanes.origin_y),
              z = query.z - load(lanes.origin_z);
  const Eight ax = load(lanes.axis_x), ay = load(lanes.axis_y), az = load(lanes.axis_z);
  const Eight foot = (x * ax + y * ay + z * az) * load(lanes.inv_length2);
  const Eight ox = x - foot * ax, oy = y - foot * ay, oz = z - foot * az;
  const Eight touching = foot - root(ox * ox + oy * oy + oz * oz) * load(lanes.lag);
  const Eight low = load(lanes.t_low), high = load(lanes.t_high);
  const Eight raised = touching < low ? low : touching;
  const Eight t = high < raised ? high : raised;
  const Eight wx = x - t * ax, wy = y - t * ay, wz = z - t * az;
  const Eight away = root(wx * wx + wy * wy + wz * wz);
  const Eight value = away - (load(lanes.r0) + t * load(lanes.taper));
  const Eight inverse = away > 0 ? 1 / away : all(0);
  store(value, to.value + first);
  store(t, to.t + first);
  store(wx * inverse, to.x + first);
  store(wy * inverse, to.y + first);
  store(wz * inverse, to.z + first);
  return least_of(value);
}

VMESH_INLINE bool out_of_reach(const ConeLanes& lanes, const LaneQuery& query, float least) {
  const float x = query.x - lanes.center_x, y = query.y - lanes.center_y, z = query.z - lanes.center_z;
  const float reach = least + lanes.radius;
  return reach <= 0 || x * x + y * y + z * z >= reach * reach;
}

/// The least of the pairwise smooth minima, see VesselField.
VMESH_INLINE void blend(const Candidates& c, LaneSample& sample) {
  for (std::size_t i = 0; i < c.count; ++i) {
    const float low = c.value[i], reach = c.reach[i];
    if (low - reach / 2 >= sample.distance) continue;
    const float x = c.x[i], y = c.y[i], z = c.z[i];
    for (std::size_t begin = 0; begin < c.count; begin += kLanes) {
      const Eight gap = load(c.value + begin) - low;
      const Eight along = x * load(c.x + begin) + y * load(c.y + begin) + z * load(c.z + begin);
      const Eight width = smaller(all(reach), load(c.reach + begin)) * (1 - along);
      const Eight room = width - gap;
      const Eight value = low - room * room / (4 * width);
      unsigned better = bits_of((room > 0) & (gap >= 0) & (value < sample.distance));
      for (; better != 0; better &= better - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(better));
        if (value[lane] >= sample.distance) continue;
        const std::size_t j = begin + lane;
        const float h = room[lane] / width[lane] / 2;
        sample.distance = value[lane];
        sample.gradient_x = (1 - h) * x + h * c.x[j];
        sample.gradient_y = (1 - h) * y + h * c.y[j];
        sample.gradient_z = (1 - h) * z + h * c.z[j];
      }
    }
  }
}

}  // namespace

LaneSample sample_lanes(const ConeLanes* lanes, std::size_t count, const LaneQuery& query) {
  Distances distances;
  const std::size_t first = query.first / kLanes;
  float least = measure(lanes[first], query, first * kLanes, distances);
  bool known[kMostConeLanes];
  for (std::size_t b = 0; b < count; ++b) {
    known[b] = b == first || !out_of_reach(lanes[b], query, least);
    if (b == first || !known[b]) continue;
    const float value = measure(lanes[b], query, b * kLanes, distances);
    least = value < least ? value : least;
  }
  LaneSample sample;
  sample.distance = sample.least = least;
  bool found = false;
  Candidates candidates;
  for (std::size_t b = 0; b < count; ++b) {
    if (!known[b]) continue;
    const Eight value = load(distances.value + b * kLanes);
    unsigned near = bits_of((value <= least) | (value < least + load(lanes[b].reach)));
    for (; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(near));
      const std::size_t n = b * kLanes + lane;
      const float x = distances.x[n], y = distances.y[n], z = distances.z[n], t = distances.t[n];
      if (!found && distances.value[n] == least) {
        found = true;
        sample.nearest = n;
        sample.t = t;
        sample.gradient_x = x, sample.gradient_y = y, sample.gradient_z = z;
      }
      const float rounding = lanes[b].rounding[lane] + t * lanes[b].rounding_taper[lane];
      const float reach = query.blend * (lanes[b].r0[lane] + t * lanes[b].taper[lane]) * rounding;
      candidates.add(distances.value[n], reach, x, y, z);
    }
  }
  if (candidates.count < 2 || query.blend == 0) return sample;
  for (std::size_t n = candidates.count; n % kLanes != 0; ++n)
    candidates.value[n] = kNever, candidates.reach[n] = candidates.x[n] = candidates.y[n] = candidates.z[n] = 0;
  blend(candidates, sample);
  return sample;
}

}  // namespace vmesh::VMESH_INSTRUCTION_SET

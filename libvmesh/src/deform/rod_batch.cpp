#include "deform/rod_batch.h"

#include <algorithm>

namespace vmesh {
namespace {

/// Slots per block of the tree; a block is processed as a whole, so that intermediate results are still in the cache.
constexpr Index kPart = 2048;

/// Blocks are in the order of slots, so children are in the block of their parent or a later one.
Index part_of(Index slot) { return slot / kPart; }

/// Height of every slot within its block: slots below it on the longest path.
std::vector<Index> heights_of(const RodScene& scene) {
  std::vector<Index> height(scene.size(), 0);
  for (Index j = static_cast<Index>(scene.size()); j-- > 0;) {
    const Index parent = scene.rods[j].parent;
    if (parent != kNone && part_of(parent) == part_of(j)) height[parent] = std::max(height[parent], height[j] + 1);
  }
  return height;
}

std::vector<Index> child_counts_of(const RodScene& scene) {
  std::vector<Index> count(scene.size(), 0);
  for (const Rod& rod : scene.rods)
    if (rod.parent != kNone) ++count[rod.parent];
  return count;
}

/// The last block first, each by height; slots with many children together.
std::vector<Index> order_of(const RodScene& scene, const std::vector<Index>& height) {
  const std::vector<Index> children = child_counts_of(scene);
  std::vector<Index> order(scene.size());
  for (Index j = 0; j < order.size(); ++j) order[j] = j;
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    if (part_of(a) != part_of(b)) return part_of(a) > part_of(b);
    return height[a] != height[b] ? height[a] < height[b] : children[a] > children[b];
  });
  return order;
}

void set(Lanes3& lanes, std::size_t lane, const Vec3& v) {
  lanes.x[lane] = v.x(), lanes.y[lane] = v.y(), lanes.z[lane] = v.z();
}

void set(Lanes33& lanes, std::size_t lane, const Mat3& m) {
  set(lanes.x, lane, m.col(0)), set(lanes.y, lane, m.col(1)), set(lanes.z, lane, m.col(2));
}

void set_lane(const RodScene& scene, Index j, RodBatch& b, std::size_t lane) {
  const Rod& rod = scene.rods[j];
  const double step = scene.options.step_s, drag = 1 + scene.options.drag_per_s * step;
  b.slot[lane] = j;
  b.mass[lane] = rod.mass, b.inertia[lane] = rod.inertia;
  b.step_mass[lane] = drag * rod.mass / (step * step), b.step_inertia[lane] = drag * rod.inertia / (step * step);
  b.radius[lane] = rod.radius;
  set(b.turn, lane, rod.turn);
  for (LanesPose& pose : b.pose) {
    set(pose.position, lane, scene.pose.position[j]);
    set(pose.frame, lane, scene.pose.frame[j]);
  }
  if (rod.parent == kNone) {
    b.rooted = true, b.is_root[lane] = 1;
    return;
  }
  const double damping = 1 + rod.damping_s / step;
  b.length[lane] = rod.length;
  b.stretch[lane] = rod.stretch, b.tip_xy[lane] = rod.tip_xy, b.tip_z[lane] = rod.tip_z;
  b.damping_rate[lane] = rod.damping_s / step;
  b.w_stretch[lane] = rod.stretch * damping, b.c_stretch[lane] = 1 / (rod.stretch * damping);
  b.w_bend[lane] = (rod.tip_xy + rod.tip_z) * damping, b.c_bend[lane] = 1 / b.w_bend[lane];
  b.w_twist[lane] = 2 * rod.tip_xy * damping, b.c_twist[lane] = 1 / b.w_twist[lane];
}

/// Fills in the places of all slots' parents and children.
void link(const RodScene& scene, RodBatches& all) {
  const Index nowhere = static_cast<Index>(all.size() * kLanes);
  for (Index place = 0; place < nowhere; ++place) {
    RodBatch& b = all.batches[place / kLanes];
    const Index j = b.slot[place % kLanes];
    b.parent[place % kLanes] = place;
    if (place % kLanes == 0) b.first_children = static_cast<Index>(all.children.size());
    if (all.place_of_slot[j] != place) continue;
    if (!scene.is_root(j)) b.parent[place % kLanes] = all.place_of_slot[scene.rods[j].parent];
    Index rank = 0;
    for (Index c = scene.rods[j].first_child; c != kNone; c = scene.rods[c].next_sibling, ++rank) {
      if (rank == b.child_ranks) {
        ++b.child_ranks;
        all.children.emplace_back().fill(nowhere);
      }
      all.children[b.first_children + rank][place % kLanes] = all.place_of_slot[c];
    }
  }
}

}  // namespace

RodBatches make_rod_batches(const RodScene& scene) {
  const std::vector<Index> height = heights_of(scene), order = order_of(scene, height);
  RodBatches all;
  all.place_of_slot.resize(scene.size());
  std::size_t lane = kLanes;
  for (std::size_t i = 0; i < order.size(); ++i, ++lane) {
    const bool alike = i > 0 && height[order[i]] == height[order[i - 1]] && part_of(order[i]) == part_of(order[i - 1]);
    if (lane >= kLanes || !alike) {
      all.batches.emplace_back().slot.fill(order[i]);
      lane = 0;
    }
    all.place_of_slot[order[i]] = static_cast<Index>((all.batches.size() - 1) * kLanes + lane);
    set_lane(scene, order[i], all.batches.back(), lane);
  }
  all.batches.emplace_back();
  link(scene, all);
  return all;
}

}  // namespace vmesh

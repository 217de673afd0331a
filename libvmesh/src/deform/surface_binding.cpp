#include "vmesh/deform/surface_binding.h"

#include <algorithm>
#include <string>

#include "vmesh/core/error.h"

#include "deform/synchronise.h"

namespace vmesh {
namespace {

/// A place in terms of the rod tree: from the slot's parent (t = 0) to the slot (t = 1).
struct SlotPlace {
  Index slot;
  double t;
};

class SlotPlaces {
 public:
  SlotPlaces(const Centerline& centerline, const RodTree& tree) : centerline_(centerline), tree_(tree) {
    for (Index n = 0; n < centerline.nodes().size(); ++n)
      if (centerline.degree(n) == 0) isolated_.push_back(tree.slot_of_node[n]);
  }

  SlotPlace at(const SurfacePlace& place, std::size_t vertex) const {
    const std::size_t segments = centerline_.segments().size();
    if (place.segment >= segments + isolated_.size() || !(place.t >= 0 && place.t <= 1))
      throw InvalidInput("vertex " + std::to_string(vertex) + ": its place on the centerline, segment " +
                         std::to_string(place.segment) + " at " + std::to_string(place.t) + ", does not exist");
    if (place.segment >= segments) return {isolated_[place.segment - segments], 0};
    const Index slot = tree_.slot_of_segment[place.segment];
    const bool turned = tree_.node[slot] == centerline_.segment(place.segment).a;
    return {slot, turned ? 1 - place.t : place.t};
  }

 private:
  const Centerline& centerline_;
  const RodTree& tree_;
  std::vector<Index> isolated_;
};

void resize(SurfaceBinding::Rest& rest, std::size_t size) {
  for (std::vector<float>* values :
       {&rest.t, &rest.x, &rest.y, &rest.z, &rest.normal_x, &rest.normal_y, &rest.normal_z})
    values->assign(size, 0);
}

void set_lane(const RodTree& tree, const SlotPlace& place, const Vec3& vertex, const Vec3& normal,
              SurfaceBinding::Rest& rest, Index lane) {
  const Index parent = tree.parent[place.slot] == kNone ? place.slot : tree.parent[place.slot];
  // The vector starts at the point of the parameter rounded to single precision.
  rest.t[lane] = static_cast<float>(place.t);
  const double t = rest.t[lane];
  const Vec3 axis = (1 - t) * tree.position[parent] + t * tree.position[place.slot];
  const Eigen::Vector3f v = (tree.frame[place.slot].transpose() * (vertex - axis)).cast<float>();
  const Eigen::Vector3f n = (tree.frame[place.slot].transpose() * normal).cast<float>();
  rest.x[lane] = v.x(), rest.y[lane] = v.y(), rest.z[lane] = v.z();
  rest.normal_x[lane] = n.x(), rest.normal_y[lane] = n.y(), rest.normal_z[lane] = n.z();
}

/// Slots with vertices, in order except that within short runs, slots with equally many vertices are adjacent.
std::vector<Index> group_order(const std::vector<std::vector<Index>>& of_slot) {
  constexpr std::size_t kWindow = 512;
  std::vector<Index> order;
  for (Index slot = 0; slot < of_slot.size(); ++slot)
    if (!of_slot[slot].empty()) order.push_back(slot);
  for (std::size_t first = 0; first < order.size(); first += kWindow) {
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(first);
    std::stable_sort(begin, begin + static_cast<std::ptrdiff_t>(std::min(kWindow, order.size() - first)),
                     [&](Index a, Index b) { return of_slot[a].size() < of_slot[b].size(); });
  }
  return order;
}

Vec3 middle_of(const std::vector<Vec3>& points) {
  if (points.empty()) return Vec3::Zero();
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return 0.5 * (low + high);
}

void check(std::span<const Vec3> vertices, std::span<const Vec3> normals, std::span<const SurfacePlace> places) {
  if (vertices.size() != normals.size() || vertices.size() != places.size())
    throw InvalidInput("binding a surface: " + std::to_string(vertices.size()) + " vertices, " +
                       std::to_string(normals.size()) + " normals and " + std::to_string(places.size()) +
                       " places; give one each");
  for (std::size_t v = 0; v < vertices.size(); ++v)
    if (!vertices[v].allFinite() || !normals[v].allFinite())
      throw InvalidInput("vertex " + std::to_string(v) + ": position and normal must be finite");
}

}  // namespace

SurfaceBinding::SurfaceBinding(const Centerline& centerline, const RodTree& tree, std::span<const Vec3> vertices,
                               std::span<const Vec3> normals, std::span<const SurfacePlace> places)
    : lane_of_vertex_(vertices.size()), rest_pose_(rest_pose(tree)), origin_(middle_of(tree.position)) {
  check(vertices, normals, places);
  const SlotPlaces slot_places(centerline, tree);
  std::vector<std::vector<Index>> of_slot(tree.size());
  std::vector<SlotPlace> at;
  for (Index v = 0; v < vertices.size(); ++v) {
    at.push_back(slot_places.at(places[v], v));
    of_slot[at[v].slot].push_back(v);
  }
  const std::vector<Index> order = group_order(of_slot);
  std::size_t blocks = 0;
  for (std::size_t first = 0; first < order.size(); first += kLanes) {
    Group& group = groups_.emplace_back();
    group.first_block = blocks;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const bool used = first + i < order.size();  // the last group repeats its first slot
      const Index slot = order[used ? first + i : first];
      group.slot[i] = slot;
      group.parent[i] = tree.parent[slot] == kNone ? slot : tree.parent[slot];
      for (std::size_t k = 0; k < 9; ++k) group.turn[kLanes * k + i] = static_cast<float>(tree.turn[slot].data()[k]);
      if (!used) continue;
      for (std::size_t k = 0; k < of_slot[slot].size(); ++k)
        lane_of_vertex_[of_slot[slot][k]] = static_cast<Index>((blocks + k) * kLanes + i);
      group.block_count = std::max(group.block_count, of_slot[slot].size());
    }
    blocks += group.block_count;
  }
  resize(rest_, blocks * kLanes);
  for (Index v = 0; v < vertices.size(); ++v) set_lane(tree, at[v], vertices[v], normals[v], rest_, lane_of_vertex_[v]);
}

DeformedSurface SurfaceBinding::make_surface(Normals normals) const {
  DeformedSurface surface;
  surface.origin = origin_;
  surface.x.resize(lane_count());
  surface.y = surface.z = surface.x;
  if (normals == Normals::with) surface.normal_x = surface.normal_y = surface.normal_z = surface.x;
  apply(rest_pose_, surface);
  return surface;
}

void SurfaceBinding::apply(const Pose& pose, DeformedSurface& surface) const noexcept { apply(pose, {}, surface); }

void SurfaceBinding::apply(const Pose& pose, std::span<const char> moved, DeformedSurface& surface,
                           InstructionSet set) const noexcept {
  VMESH_VARIANT(set, synchronise)({groups_, rest_, pose, moved}, surface);
}

}  // namespace vmesh

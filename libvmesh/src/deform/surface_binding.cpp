#include "vmesh/deform/surface_binding.h"

#include <algorithm>
#include <string>

#include "vmesh/core/error.h"

#include "deform/synchronise.h"

namespace vmesh {
namespace {

using Block = SurfaceBinding::Block;

/// A place in terms of the tree: from the slot's parent (t = 0) to the slot (t = 1).
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

void set_lane(const RodTree& tree, const SlotPlace& place, const Vec3& vertex, const Vec3& normal, Block& block,
              std::size_t lane) {
  const Index parent = tree.parent[place.slot] == kNone ? place.slot : tree.parent[place.slot];
  const Vec3 axis = (1 - place.t) * tree.position[parent] + place.t * tree.position[place.slot];
  const Eigen::Vector3f v = (tree.frame[place.slot].transpose() * (vertex - axis)).cast<float>();
  const Eigen::Vector3f n = (tree.frame[place.slot].transpose() * normal).cast<float>();
  block.t[lane] = place.t;
  block.x[lane] = v.x(), block.y[lane] = v.y(), block.z[lane] = v.z();
  block.normal_x[lane] = n.x(), block.normal_y[lane] = n.y(), block.normal_z[lane] = n.z();
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
    : lane_of_vertex_(vertices.size()), rest_(rest_pose(tree)) {
  check(vertices, normals, places);
  const SlotPlaces slot_places(centerline, tree);
  std::vector<std::vector<Index>> of_slot(tree.size());
  std::vector<SlotPlace> at;
  for (Index v = 0; v < vertices.size(); ++v) {
    at.push_back(slot_places.at(places[v], v));
    of_slot[at[v].slot].push_back(v);
  }
  for (Index slot = 0; slot < tree.size(); ++slot) {
    const std::vector<Index>& own = of_slot[slot];
    if (own.empty()) continue;
    const Index first = static_cast<Index>(blocks_.size()),
                count = static_cast<Index>((own.size() + kLanes - 1) / kLanes);
    const Index parent = tree.parent[slot] == kNone ? slot : tree.parent[slot];
    runs_.push_back({slot, parent, first, count, tree.turn[slot]});
    blocks_.resize(first + count);
    for (std::size_t i = 0; i < own.size(); ++i) {
      set_lane(tree, at[own[i]], vertices[own[i]], normals[own[i]], blocks_[first + i / kLanes], i % kLanes);
      lane_of_vertex_[own[i]] = static_cast<Index>(first * kLanes + i);
    }
  }
}

DeformedSurface SurfaceBinding::make_surface() const {
  DeformedSurface surface;
  surface.x.resize(lane_count());
  surface.y = surface.z = surface.x;
  surface.normal_x.resize(lane_count());
  surface.normal_y = surface.normal_z = surface.normal_x;
  apply(rest_, surface);
  return surface;
}

void SurfaceBinding::apply(const Pose& pose, DeformedSurface& surface) const noexcept { apply(pose, {}, surface); }

void SurfaceBinding::apply(const Pose& pose, std::span<const char> moved, DeformedSurface& surface) const noexcept {
  synchronise({runs_, blocks_.data(), pose, moved}, surface);
}

}  // namespace vmesh

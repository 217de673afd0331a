#pragma once

#include <span>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// A point of a centerline. Position and radius in mm.
struct CenterlineNode {
  Vec3 position = Vec3::Zero();
  double radius = 0;
};

/// A straight line of a centerline between nodes `a` and `b`. The vessel around it is the round cone of the two node
/// spheres (their convex hull).
struct CenterlineSegment {
  Index a = kNone;
  Index b = kNone;
};

/// A centerline graph: nodes with radii, straight segments; loops and several components are allowed.
/// Always valid once built:
///   - at least one node; positions finite; radii finite and > 0;
///   - segments join two different existing nodes at different positions, no pair twice.
/// A node without segments is allowed and stands for a sphere.
class Centerline {
 public:
  /// Throws InvalidInput listing every problem with its element (see validate() in validation.h).
  Centerline(std::vector<CenterlineNode> nodes, std::vector<CenterlineSegment> segments);

  const std::vector<CenterlineNode>& nodes() const { return nodes_; }
  const std::vector<CenterlineSegment>& segments() const { return segments_; }

  const CenterlineNode& node(Index n) const { return nodes_[n]; }
  const CenterlineSegment& segment(Index s) const { return segments_[s]; }

  /// Segments incident to node `n`, in ascending order.
  std::span<const Index> incident_segments(Index n) const {
    return {incidence_.data() + offsets_[n], incidence_.data() + offsets_[n + 1]};
  }
  std::size_t degree(Index n) const { return offsets_[n + 1] - offsets_[n]; }

  /// The node of segment `s` that is not `n`.
  Index other_node(Index s, Index n) const { return segments_[s].a == n ? segments_[s].b : segments_[s].a; }

  /// Euclidean length of segment `s`.
  double length(Index s) const { return (nodes_[segments_[s].b].position - nodes_[segments_[s].a].position).norm(); }

  /// The point at parameter `t` in [0, 1] of segment `s`, and the radius there (linear interpolation).
  Vec3 point_at(Index s, double t) const {
    return (1 - t) * nodes_[segments_[s].a].position + t * nodes_[segments_[s].b].position;
  }
  double radius_at(Index s, double t) const {
    return (1 - t) * nodes_[segments_[s].a].radius + t * nodes_[segments_[s].b].radius;
  }

  /// Component number of every node; components are numbered by their lowest node.
  const std::vector<Index>& component_of_node() const { return component_; }
  std::size_t component_count() const { return component_count_; }

  /// Independent cycles: segments - nodes + components. 0 for a forest.
  std::size_t cycle_rank() const { return segments_.size() + component_count_ - nodes_.size(); }

  /// Sum of length / mean radius over the segments: the size of the meshing task, independent of scale.
  double length_in_radii() const;

 private:
  void index_incidence();
  void number_components();

  std::vector<CenterlineNode> nodes_;
  std::vector<CenterlineSegment> segments_;
  std::vector<Index> offsets_, incidence_;
  std::vector<Index> component_;
  std::size_t component_count_ = 0;
};

}  // namespace vmesh

#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

struct FieldExcerpt;

/// What a VesselField knows about a point.
struct FieldSample {
  double distance = 0;           ///< signed, mm; negative inside the vessel
  Vec3 gradient = Vec3::Zero();  ///< of the distance; unit for the plain union, zero on a vessel's axis
  Index cone = kNone;            ///< the closest round cone
  double t = 0;                  ///< parameter on its axis of the sphere that touches the boundary there, in [0, 1]
};

/// The round cones of a centerline (convex hulls of two spheres), and which of them count as one volume. Cone
/// i < segments().size() belongs to segment i; then follow the isolated nodes as spheres. A VesselField answers queries
/// at points on top of it, and takes several times its memory.
class ConeRelations {
 public:
  /// `blend` in [0, 2]. Keeps a reference to `centerline`, which must outlive the relations.
  explicit ConeRelations(const Centerline& centerline, double blend = 0);
  /// The part from which `excerpt` was taken; `centerline` is the excerpt's. Throws InvalidInput for an inconsistent
  /// excerpt.
  ConeRelations(const Centerline& centerline, const FieldExcerpt& excerpt);

  const Centerline& centerline() const { return *centerline_; }
  double blend() const { return blend_; }
  std::size_t cone_count() const { return runs_.size(); }

  /// The node a cone starts and ends at (equal for an isolated node).
  Index first_node(Index cone) const { return is_sphere(cone) ? isolated_node(cone) : centerline_->segment(cone).a; }
  Index last_node(Index cone) const { return is_sphere(cone) ? isolated_node(cone) : centerline_->segment(cone).b; }

  /// The cone of an isolated node.
  Index sphere_of(Index node) const {
    const auto rank = std::lower_bound(isolated_.begin(), isolated_.end(), node) - isolated_.begin();
    return static_cast<Index>(centerline_->segments().size()) + static_cast<Index>(rank);
  }

  /// Vessel radius at parameter `t` of `cone`.
  double radius_at(Index cone, double t) const {
    const double r0 = radius_of(first_node(cone));
    return r0 + t * (radius_of(last_node(cone)) - r0);
  }
  double max_radius(Index cone) const { return std::max(radius_of(first_node(cone)), radius_of(last_node(cone))); }
  /// How much of the blend is left to a cone at parameter `t`, in [0, 1].
  double rounding_at(Index cone, double t) const {
    const double first = rounding_of(first_node(cone));
    return first + t * (rounding_of(last_node(cone)) - first);
  }
  /// How much of the blend is left at a node, in [0, 1].
  double rounding_of(Index node) const { return rounding_.empty() ? 1 : rounding_[node]; }
  /// Point of the axis at parameter `t` of `cone`.
  Vec3 axis_point(Index cone, double t) const {
    const Vec3& origin = centerline_->node(first_node(cone)).position;
    return origin + t * (centerline_->node(last_node(cone)).position - origin);
  }

  /// Exact signed distance to one cone.
  FieldSample sample_cone(const Vec3& p, Index cone) const;

  /// The cones that take part in a local query with hint `cone`, `cone` included, ascending.
  std::span<const Index> local_cones(Index cone) const {
    if (!complete_.empty() && !complete_[cone]) throw_incomplete(cone);
    const Index row = row_of(cone);
    return {local_.data() + local_offsets_[row], local_.data() + local_offsets_[row + 1]};
  }

  /// Whether both begin at one node of very many segments, and so count as one volume; known at once.
  bool are_in_one_fan(Index i, Index j) const {
    return std::max(i, j) < hub_of_.size() && hub_of_[i] != kNone && hub_of_[i] == hub_of_[j];
  }

  /// Whether two cones count as one volume: they are local to each other, and not only because, where their vessels
  /// part, the rounding between them extends farther than they touch.
  bool are_one_volume(Index i, Index j) const;

  /// Pairs of cones that are not blended where both are near because their vessels have parted and come near again; the
  /// lower number first, ascending.
  const std::vector<std::pair<Index, Index>>& apart() const { return apart_; }

  /// For each of local_cones(cone), whether it is local only because of the rounding where vessels part.
  std::span<const char> parting(Index cone) const {
    const Index row = row_of(cone);
    return {is_parting_.data() + local_offsets_[row], is_parting_.data() + local_offsets_[row + 1]};
  }

  /// Consecutive cones along the graph form a run. From sphere to sphere along it, neither a distance nor a distance
  /// less the widest blend changes by more than `travel` does.
  struct Run {
    Index number = kNone;
    double travel = 0;  ///< from the run's start to the cone's end, mm
  };
  const Run& run(Index cone) const { return runs_[cone]; }

 private:
  bool is_sphere(Index cone) const { return cone >= centerline_->segments().size(); }
  Index isolated_node(Index cone) const { return isolated_[cone - centerline_->segments().size()]; }
  double radius_of(Index node) const { return centerline_->node(node).radius; }
  void find_isolated();
  void measure_runs();
  void find_local_cones();
  void list_local_cones(const std::vector<std::pair<Index, Index>>& local,
                        const std::vector<std::pair<Index, Index>>& parting);
  void list_fans();
  Index row_of(Index cone) const { return row_.empty() ? cone : row_[cone]; }
  [[noreturn]] static void throw_incomplete(Index cone);

  const Centerline* centerline_;
  double blend_;
  std::vector<Index> isolated_;  // nodes
  std::vector<Run> runs_;
  std::vector<Index> local_offsets_, local_;
  std::vector<Index> row_;                      // of cones, in local_offsets_; empty: each has its own
  std::vector<Index> hub_of_;                   // of segments in fans; empty if there are none
  std::vector<char> complete_;                  // of cones; empty: all are
  std::vector<char> is_parting_;                // of local_
  std::vector<std::pair<Index, Index>> apart_;  // ascending
  std::vector<double> rounding_;                // of nodes; empty: 1 for all
};

}  // namespace vmesh

#pragma once

#include <array>
#include <span>
#include <vector>

#include "vmesh/core/instruction_set.h"
#include "vmesh/deform/rod_tree.h"

namespace vmesh {

/// Where a vertex belongs on a centerline: segment, and parameter in [0, 1] from its node a to its node b. Isolated
/// nodes are numbered after the segments, by rank.
struct SurfacePlace {
  Index segment = kNone;
  double t = 0;
};

/// The nearest point of the centerline to every point, by a box hierarchy over the segments; O(n log n).
std::vector<SurfacePlace> nearest_places(const Centerline& centerline, std::span<const Vec3> points);

/// A moving surface: arrays by lane, not by vertex (SurfaceBinding::lane_of_vertex()). Positions in mm, relative to
/// `origin`, so that single precision is relative to the vessel's size wherever it lies; normals of unit length, or
/// none. Lanes without a vertex hold arbitrary numbers.
struct DeformedSurface {
  Vec3 origin = Vec3::Zero();
  std::vector<float> x, y, z;
  std::vector<float> normal_x, normal_y, normal_z;

  Vec3 position(Index lane) const { return origin + Vec3(x[lane], y[lane], z[lane]); }
  Vec3 normal(Index lane) const { return {normal_x[lane], normal_y[lane], normal_z[lane]}; }
};

/// Keeps a surface attached to a moving centerline (Eqs. 1, 2, 9 and 10). A vertex is the point at its parameter on its
/// segment plus a vector: the mean of the vectors carried by two frames, that of the segment and that of the parent's
/// segment. As the vector's rest coordinates in the two differ by Eq. 3's rotation, one matrix per segment suffices.
/// Segments with similar numbers of vertices are processed eight at a time, in blocks of eight lanes with a vertex of
/// each.
class SurfaceBinding {
 public:
  static constexpr std::size_t kLanes = 8;

  /// `vertices`, `normals` (unit) and `places`: of the surface around the tree at rest. Throws InvalidInput for spans
  /// of different length, places that do not exist and numbers that are not finite.
  SurfaceBinding(const Centerline& centerline, const RodTree& tree, std::span<const Vec3> vertices,
                 std::span<const Vec3> normals, std::span<const SurfacePlace> places);

  std::size_t lane_count() const { return rest_.t.size(); }
  const std::vector<Index>& lane_of_vertex() const { return lane_of_vertex_; }

  /// Whether a surface has normals, which cost as much as positions.
  enum class Normals { without, with };

  /// Arrays of the right length, filled with the surface at rest. The origin is the middle of the tree at rest.
  DeformedSurface make_surface(Normals normals = Normals::without) const;

  /// Writes the surface around `pose`, with normals if it has any. Single precision: accurate to 1e-6 times the
  /// connecting vector of Eq. 10 plus 2e-7 times the largest coordinate relative to the origin; the bytes do not depend
  /// on the processor's vector width.
  void apply(const Pose& pose, DeformedSurface& surface) const noexcept;
  /// The same where `moved` (one per slot, CenterlineSimulation::moved()) says that something changed.
  void apply(const Pose& pose, std::span<const char> moved, DeformedSurface& surface,
             InstructionSet set = best_instruction_set()) const noexcept;

  /// Constants of every lane.
  struct Rest {
    std::vector<float> t;                             ///< from the parent's position to the slot's
    std::vector<float> x, y, z;                       ///< connecting vector in the slot's frame
    std::vector<float> normal_x, normal_y, normal_z;  ///< in the slot's frame
  };
  /// Eight slots and their blocks, which have a lane of each.
  struct Group {
    std::array<Index, kLanes> slot, parent;  ///< equal for an isolated node
    std::size_t first_block, block_count;
    std::array<float, 9 * kLanes> turn;  ///< RodTree::turn, entry by entry, by columns
  };

 private:
  std::vector<Group> groups_;
  Rest rest_;
  std::vector<Index> lane_of_vertex_;
  Pose rest_pose_;
  Vec3 origin_ = Vec3::Zero();
};

}  // namespace vmesh

#pragma once

#include <vector>

#include "vmesh/core/box_tree.h"
#include "vmesh/core/progress.h"
#include "vmesh/volume/round_cone.h"

#include "skeleton_graph.h"

namespace vmesh::skeleton {

/// Points spread over the vessels' wall by area, each standing for a share of it.
struct FitSamples {
  std::vector<Vec3> points;
  std::vector<double> areas;  ///< mm^2
  /// How far the wall may be from the point along the normal, mm: a wall between two voxels is anywhere between them.
  std::vector<double> slack;

  std::size_t size() const { return points.size(); }
};

/// Centres of voxels beside the wall, inside and outside.
struct FitVoxels {
  std::vector<Vec3> points;
  std::vector<bool> inside;
  double volume = 0;  ///< of a voxel, mm^3
  double blur = 0;    ///< how far from the wall the mask may err, mm

  std::size_t size() const { return points.size(); }
};

/// The round cones of a graph's edges, then the spheres of its nodes without an edge.
class GraphCones {
 public:
  explicit GraphCones(const Graph& graph);

  struct Place {
    Index cone = kNone;
    double distance = 0, t = 0;  ///< mm, signed; parameter on the axis
  };
  /// The closest of all cones to every point.
  std::vector<Place> closest(const std::vector<Vec3>& points) const;
  /// The closest of the cones near `from` along the graph, and so on until there is no closer one.
  Place closest(const Vec3& point, Index from) const;

  /// Of the cones' boxes.
  BoxTree tree() const;
  const RoundCone& cone(Index c) const { return cones_[c]; }
  std::size_t size() const { return cones_.size(); }
  Index first_node(Index c) const { return ends_[c][0]; }
  Index last_node(Index c) const { return ends_[c][1]; }
  double radius_at(const Place& place) const { return cones_[place.cone].radius_at(place.t); }

 private:
  std::vector<RoundCone> cones_;
  std::vector<std::array<Index, 2>> ends_;
  std::vector<Index> near_at_, near_;  // of every cone: those at most two edges away
};

/// Removes end chains that do not stick out of the other vessels, or no more than a bump does: second ways to one end
/// of a vessel that is not round, and what a rough wall leaves. Returns the number removed.
std::size_t prune_contained(Graph& graph);

/// How the nodes of a graph are moved.
struct FitRounds {
  double spacing = 1;  ///< of the nodes, radii
  /// Chains are smoother where this is large beside their radius, mm; 0 for a wall that is not made of voxels.
  double voxel = 0;
  int most = 20;
  /// Weights of the bends of chains, relative to what the samples of a node weigh; more by `rough` times the square of
  /// voxels per radius.
  double smooth_position = 0.01, smooth_radius = 0.1, rough = 5;
};

/// Moves the nodes of `graph` and changes their radii so that the boundary of the union of its round cones comes as
/// close to the wall as possible: weighted least squares of the signed distances beyond the samples' slack
/// (Gauss-Newton), with a little weight on smooth chains. Far samples count less, as they may belong to a region that
/// the graph does not reach. Ends thus come to lie where their spheres touch the wall's ends; fixed nodes stay. Polls
/// `progress` for cancellation. Returns the root mean square of the distances beyond the slack, far ones left out, mm.
double fit_cones(Graph& graph, const FitSamples& samples, const FitRounds& rounds, const Progress& progress);

/// The same for what voxels tell, which is more: that their centres are inside or outside. Logistic regression of
/// these on the distance to the union of the round cones, solved by its quadratic bounds (Boehning and Lindsay,
/// "Monotonicity of quadratic-approximation algorithms", 1988; Jaakkola and Jordan 2000 for the bound used). Where it
/// is best, the vessels have the volume of their voxels, so that radii of thin vessels are not too large: a wall half a
/// voxel away from the centres inside, however smoothed, would make them so.
void fit_cones(Graph& graph, const FitVoxels& voxels, const FitRounds& rounds, const Progress& progress);

}  // namespace vmesh::skeleton

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/core/types.h"
#include "vmesh/mesh/topology.h"

namespace vmesh {

/// What a sound surface does not have.
enum class DefectKind {
  not_closed,      ///< a boundary edge that is not at an opening
  not_manifold,    ///< an edge with three faces, a vertex with two fans, or faces that disagree about the outside
  wrong_topology,  ///< components or holes that the centerline does not have, or lacks some that it has
  inside_out,      ///< a component that encloses a negative volume
  crossing_faces,  ///< faces that intersect other than in what they have in common
  bad_triangle,    ///< a triangle of skewness above kWorstSkewness, see metric_skewness()
  node_outside     ///< a node of the centerline that is not inside
};

std::string_view to_string(DefectKind kind);

/// Skewness above which a triangle is a defect: its smallest angle is below 6 degrees, or its largest above 168.
/// Surfaces that grew well reach 0.5.
inline constexpr double kWorstSkewness = 0.9;

/// What was measured of a surface whose openings are closed by lids.
struct SurfaceCheck {
  Topology topology;
  std::size_t crossing_pairs = 0;  ///< of faces, lids aside
  std::optional<std::size_t>
      nodes_inside;  ///< of the centerline's, with those at openings; none: inside is not defined
};

/// Defects of one kind near each other.
struct Defect {
  DefectKind kind = DefectKind::crossing_faces;
  Vec3 position = Vec3::Zero();  ///< of one of them, mm
  std::size_t count = 0;         ///< pairs of faces, faces, edges or nodes
  Index segment = kNone;         ///< of the centerline, where the vertex nearest to the place is bound
  Index branch = kNone;          ///< in find_branches(), of that segment
  Index node = kNone;            ///< the centerline's node nearest to the place
  std::string message;           ///< what, how many, at which position
};

}  // namespace vmesh

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/core/types.h"
#include "vmesh/mesh/topology.h"

namespace vmesh {

/// What a sound surface must not have.
enum class DefectKind {
  not_closed,      ///< a boundary edge that is not at an opening
  not_manifold,    ///< an edge with three faces, a vertex with two fans, or faces that disagree about the outside
  wrong_topology,  ///< components or genus differ from those of the centerline
  inside_out,      ///< a component that encloses a negative volume
  crossing_faces,  ///< faces that intersect other than at common vertices and edges
  bad_triangle,    ///< a triangle of equiangle skewness above kWorstSkewness, see metric_skewness()
  node_outside     ///< a node of the centerline that is not inside
};

std::string_view to_string(DefectKind kind);

/// Skewness above which a triangle is a defect: its smallest angle is below 6 degrees, or its largest above 168.
/// Well-grown surfaces reach 0.5.
inline constexpr double kWorstSkewness = 0.9;

/// Measurements of a surface whose openings are closed by lids.
struct SurfaceCheck {
  Topology topology;
  std::size_t crossing_pairs = 0;  ///< of faces, without lids
  std::optional<std::size_t>
      nodes_inside;  ///< for every node of the centerline, those at openings included; empty: inside is undefined
};

/// One or more defects of the same kind near each other.
struct Defect {
  DefectKind kind = DefectKind::crossing_faces;
  Vec3 position = Vec3::Zero();  ///< of one of them, mm
  std::size_t count = 0;         ///< pairs of faces, faces, edges or nodes
  Index segment = kNone;         ///< of the centerline: the binding of the vertex nearest to `position`
  Index branch = kNone;          ///< in find_branches(), of that segment
  Index node = kNone;            ///< the centerline's node nearest to `position`
  std::string message;           ///< what, how many, at which position
};

}  // namespace vmesh

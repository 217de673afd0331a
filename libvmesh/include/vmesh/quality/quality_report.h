#pragma once

#include <map>

#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/quality/distribution.h"

namespace vmesh {

/// TriangleMeasures of every face, one list per measure.
struct FaceMeasures {
  std::vector<double> area_mm2, min_angle_deg, max_angle_deg, equiangle_skewness, shortest_to_longest_edge,
      double_inradius_to_circumradius, scaled_inradius_to_longest_edge;
};

/// One pass over the faces, on the threads of the caller's arena (oneTBB). Throws InvalidInput when a face names a
/// vertex that does not exist, or a corner is not finite.
FaceMeasures measure_faces(const TriMesh& mesh);

/// Calls `visit(name, values, low, high)` for every measure; `low` and `high` are the ends of a histogram, equal where
/// there are no natural ones.
template <class Measures, class Visitor>
void for_each_face_measure(Measures& measures, Visitor visit) {
  visit("equiangle_skewness", measures.equiangle_skewness, 0.0, 1.0);
  visit("min_angle_deg", measures.min_angle_deg, 0.0, 60.0);
  visit("max_angle_deg", measures.max_angle_deg, 60.0, 180.0);
  visit("shortest_to_longest_edge", measures.shortest_to_longest_edge, 0.0, 1.0);
  visit("double_inradius_to_circumradius", measures.double_inradius_to_circumradius, 0.0, 1.0);
  visit("scaled_inradius_to_longest_edge", measures.scaled_inradius_to_longest_edge, 0.0, 1.0);
  visit("area_mm2", measures.area_mm2, 0.0, 0.0);
}

/// Two faces that intersect, and approximately where: midway between their centres.
struct IntersectingFaces {
  Index first = kNone, second = kNone;
  Vec3 position = Vec3::Zero();
};

/// Defects of the faces and their connectivity.
struct DefectReport {
  Topology topology;
  std::vector<Index> degenerate_faces, duplicate_faces;
  std::vector<IntersectingFaces> self_intersections;
  std::map<Index, std::size_t>
      vertices_of_valence;  ///< number of vertices by valence; vertices without a face left out
};

/// Throws InvalidInput as measure_faces() does.
DefectReport find_defects(const TriMesh& mesh);

}  // namespace vmesh

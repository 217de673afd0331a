#pragma once

#include <optional>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/quality/closest_point.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh::fitting {

/// A point of the reference for which a counterpart on the surface is sought.
struct ReferenceSample {
  Vec3 position = Vec3::Zero();
  Index face = kNone;
  double area = 0;  ///< mm^2 that it represents
};

/// The surface to which another one is fitted: facing outwards, with a vessel assigned to every face.
class FitReference {
 public:
  /// Throws InvalidInput for a mesh without faces and one whose faces disagree about the outside.
  FitReference(const TriMesh& mesh, const VesselField& field);

  const TriMesh& mesh() const { return mesh_; }
  const ClosestPointIndex& index() const { return *index_; }
  const Vec3& normal(Index f) const { return normals_[f]; }
  Index cone(Index f) const { return cones_[f]; }
  /// Whether a face is near enough to its vessel to be the vessel's wall; if not, it is ignored.
  bool is_near(Index f) const { return near_[f]; }
  bool turned() const { return turned_; }
  /// Whether `p`, a point of face `f`, lies on the border of an open reference.
  bool on_border(Index f, const Vec3& p) const;
  /// The faces across the edges of face `f`; kNone at a border.
  const Triangle& across(Index f) const { return across_[f]; }
  Vec3 center(Index f) const;
  double area(Index f) const;

  /// About `count` points with a density proportional to 1 / radius^2 of the vessels.
  std::vector<ReferenceSample> samples(const VesselField& field, std::size_t count) const;
  /// Ends and midpoints of sharp edges, which their faces' samples miss; they represent no area.
  std::vector<ReferenceSample> rim_samples() const;

 private:
  void connect();
  void turn_outwards(const VesselField& field);
  void find_cones(const VesselField& field);
  void find_near(const VesselField& field);

  TriMesh mesh_;
  bool turned_ = false;
  std::vector<Triangle> across_;
  std::optional<ClosestPointIndex> index_;  // once the faces are oriented
  std::vector<Vec3> normals_;
  std::vector<Index> cones_;
  std::vector<char> near_;
};

/// The larger radius of a cone's ends, mm.
double widest_radius(const VesselField& field, Index cone);

/// Whether two cones belong to one stretch of vessel.
bool same_vessel(const VesselField& field, Index a, Index b);

}  // namespace vmesh::fitting

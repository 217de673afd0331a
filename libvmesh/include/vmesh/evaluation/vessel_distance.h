#pragma once

#include <vector>

#include "vmesh/core/progress.h"
#include "vmesh/quality/closest_point.h"
#include "vmesh/quality/distribution.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {

/// A point of the boundary of a vessel volume.
struct BoundarySample {
  Vec3 position = Vec3::Zero();
  double radius = 0;  ///< of the vessel there, mm
};

struct BoundarySamples {
  std::vector<BoundarySample> points;
  double per_mm2 = 0;
};

/// Points spread evenly over the boundary of the plain union of the field's round cones: on the side of every cone and
/// on the sphere of every node, except those inside another cone. Deterministic, low-discrepancy. About `count` points,
/// fewer where cones overlap: `count` by the area of all sides, or of the spheres where there are no sides.
BoundarySamples sample_boundary(const VesselField& field, std::size_t count);

/// Distances of samples on one surface from the other: area-weighted; their maximum is a lower bound of the true one.
struct VesselDistanceSide {
  Distribution mm;
  Distribution relative;  ///< in units of the local radius of the vessel
  Vec3 max_at = Vec3::Zero();
  Vec3 max_relative_at = Vec3::Zero();
  double samples_per_mm2 = 0;
};

/// The distance between a surface and the exact vessel volume, both ways.
struct VesselDistance {
  /// |signed distance| on the surface. Inside the volume, where cones overlap, a lower bound of the distance from the
  /// boundary (see VesselField).
  VesselDistanceSide from_mesh;
  /// Distance from the volume's boundary to the surface.
  VesselDistanceSide from_volume;
};

/// `field` should be without blend: its global distance is compared with the boundary of the plain union. `index` is
/// over `mesh`. Throws what sample_surface() throws, and Cancelled.
VesselDistance measure_vessel_distance(const TriMesh& mesh, const ClosestPointIndex& index, const VesselField& field,
                                       std::size_t samples, const Progress& progress = {});

/// Signed distance of every vertex from the volume, mm, negative inside.
std::vector<double> vertex_vessel_distances(const TriMesh& mesh, const VesselField& field);

}  // namespace vmesh

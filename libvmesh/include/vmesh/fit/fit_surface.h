#pragma once

#include <string>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/core/progress.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/quality/hausdorff.h"
#include "vmesh/quality/sampled_distance.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// A surface around a centerline, as generate_surface() makes it.
struct VesselSurface {
  TriMesh mesh;
  std::vector<CenterlineBinding> binding;  ///< one per vertex
  std::vector<Opening> openings;
};

/// How to fit a surface to another one.
struct FitOptions {
  /// Rounds of correspondence, least squares and repair, 1 to 100; in the first half, the size of triangles changes as
  /// well.
  int rounds = 16;
  /// Refine triangles where the error is large and coarsen them where it is small. Otherwise the triangles stay the
  /// same.
  bool resize = true;
  /// Maximum number of vertices; 0: a twentieth more than the surface has, or as many as `error` needs.
  std::size_t max_vertices = 0;
  /// Error to reach with as few vertices as possible, mm: 95 % of either surface is nearer to the other than this. 0:
  /// none; the number of vertices is then kept.
  double error = 0;
  /// Largest distance of any point of either surface from the other, mm, but for regions that the report lists as
  /// uncovered or unsupported: vertices are added, at most `max_vertices`, where it is larger. Proven, or
  /// FitReport::beyond has the places. 0: none. Needs `resize`.
  double max_error = 0;
  /// How much longer than wide triangles may be, 1 to kMostElongation: along the direction in which the reference is
  /// curved least, by the root of the ratio of its curvatures. Above 1, a fit with several times as many even triangles
  /// is coarsened to the number wanted and fitted again; needs `resize`.
  double elongation = 1;
  /// For a surface that will be deformed with its centerline: with an elongation, a vertex is left out only if no edge
  /// then reaches farther along the vessel than the segments there are long, or is no longer than those of the surface
  /// as given. So every bend has vertices.
  bool deformable = false;
  /// Equiangle skewness beyond which no step may worsen a triangle; 0.1 to 0.9. With an elongation, that of
  /// metric_skewness(), and at least 0.8.
  double max_skewness = 0.4;
  /// Points on each surface for mean, RMS and percentiles of the report; a quarter of them before the fit.
  std::size_t samples = 25'000;
  /// Width of the interval that contains a Hausdorff distance, mm.
  double tolerance = 1e-3;
  /// Threads to work on; 0: as many as the machine has. The result does not depend on it.
  int threads = 0;
};

/// The distance between a surface and the reference, both ways.
struct FitDistance {
  Hausdorff hausdorff;  ///< forward: from the surface to the reference
  SampledDistance from_surface, from_reference;

  double mean() const { return std::max(from_surface.distance.mean, from_reference.distance.mean); }
  double rms() const { return std::max(from_surface.distance.rms, from_reference.distance.rms); }
  double p95() const { return std::max(from_surface.distance.p95, from_reference.distance.p95); }
};

/// A region of one surface without a counterpart on the other: faces joined by edges.
struct UnmatchedPart {
  Vec3 position = Vec3::Zero();  ///< of its point farthest from the other surface, mm
  double distance = 0;           ///< of that point, mm
  double area = 0;               ///< mm^2
  bool inside = false;           ///< the point lies inside of the other surface
  Index segment = kNone;         ///< of the centerline, the nearest
};

struct FitReport {
  std::size_t vertices_before = 0;
  FitDistance before, after;  ///< without components of the reference that belong to no vessel
  /// Components of the reference that mostly belong to no vessel, and their area, mm^2.
  std::size_t parts_apart = 0;
  double area_apart = 0;
  /// Regions of the reference that no vessel covers: missing twigs, neighbouring organs. The fit ignores them. Largest
  /// first.
  std::vector<UnmatchedPart> uncovered;
  /// Regions of the surface that the reference lacks: vessels beyond its end; inside it, walls between the legs of a
  /// hairpin in one wide lumen.
  std::vector<UnmatchedPart> unsupported;
  /// With FitOptions::max_error, regions of either surface that are farther from the other, largest first; the regions
  /// above then reach to where the distance is smaller. Empty: the largest distance is proven.
  std::vector<UnmatchedPart> beyond;
  std::vector<Defect> nodes_outside;  ///< of the centerline, outside the fitted surface; for a GenerateResult only
  bool turned = false;                ///< the reference faced inwards and was turned over
  int rounds = 0;                     ///< of correspondence
};

struct FitResult {
  VesselSurface surface;
  std::vector<double> radius;    ///< local vessel radius at every vertex's binding, mm
  std::vector<Vec3> elongation;  ///< of every vertex, see GenerateResult; empty where triangles are even
  FitReport report;
};

/// The holes of an open surface as openings, ordered by their lowest vertices; Opening::node and radius are unknown
/// (kNone, 0). The mesh is manifold and oriented.
std::vector<Opening> find_openings(const TriMesh& mesh);

/// Moves `surface` onto `reference` by least squares: vertices and, with options.resize, the size of the triangles. The
/// surface stays sound: it keeps its components, handles and openings, and no faces cross.
///
/// Points of both surfaces are paired with the closest point of the other that faces the same way and belongs to the
/// same vessel along the graph, within 1.5 local radii; squared distances along the line between the two are minimised
/// over all vertices at once (tangent distances; Pottmann, Huang, Yang, Hu, "Geometry and convergence analysis of
/// algorithms for registration of 3D shapes", 2006), with tangential springs and smooth increments. Steps are limited
/// so that triangles keep their shape and no faces cross. With options.resize, walls inside of the reference, as in a
/// crevice between two vessels that are one lumen there, give way to what spans their mouth.
///
/// `surface` is bound to `centerline`. `reference` faces outwards or inwards as a whole; it may be open and may have
/// parts that belong to no vessel. Deterministic. Throws InvalidInput for a reference without faces, one whose faces
/// disagree about the outside, one that is nowhere near the surface, a surface that is not manifold and oriented, that
/// has faces that cross or whose binding does not fit, and options out of range; Unsupported if there is not enough
/// free memory, also midway before `error` adds vertices; Cancelled.
FitResult fit_surface(const VesselSurface& surface, const Centerline& centerline, const TriMesh& reference,
                      const FitOptions& options = {}, const Progress& progress = {});

/// The same for a generated surface: mesh, binding, radii, openings, check and defects become those of the fitted one.
/// A node of the centerline outside the fitted surface is not a defect, but is reported.
FitReport fit_surface(GenerateResult& result, const Centerline& centerline, const TriMesh& reference,
                      const FitOptions& options = {}, const Progress& progress = {});

/// Finds anew what of a fitted surface is uncovered, unsupported and beyond FitOptions::max_error, after it was changed
/// once more. Throws like fit_surface().
void find_far_parts(FitReport& report, const VesselSurface& surface, const Centerline& centerline,
                    const TriMesh& reference, double max_error);

}  // namespace vmesh

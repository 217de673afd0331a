#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/centerline/simplification.h"
#include "vmesh/core/progress.h"
#include "vmesh/core/stage_time.h"
#include "vmesh/edit/refused_steps.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/soundness.h"

namespace vmesh {

struct SeparatedCenterline;

/// guided: a tube per stretch of vessel with a cross-section of its own and a seed per junction between them; the
/// surface has the topology of the centerline. paper: a single seed per component, as published.
enum class GrowthMethod { guided, paper };

std::string_view to_string(GrowthMethod method);
/// Throws InvalidInput unless `text` is "guided" or "paper".
GrowthMethod parse_growth_method(std::string_view text);

/// Resolutions to choose from.
enum class Preset { low, high };
/// GenerateOptions::around of a preset: 6 or 12.
constexpr int vertices_around(Preset preset) { return preset == Preset::high ? 12 : 6; }

/// Where vertices lie. inscribed: on the boundary, so that faces cut off some of the volume. balanced: lifted off it so
/// that the signed distance to the boundary averages to zero around every vertex, which keeps the volume.
enum class Placement { inscribed, balanced };

std::string_view to_string(Placement placement);
/// Throws InvalidInput unless `text` is "inscribed" or "balanced".
Placement parse_placement(std::string_view text);

/// How far the surface may be from the boundary of the volume, and the boundary from the surface: the smaller of two
/// limits.
struct ErrorLimit {
  double mm = std::numeric_limits<double>::infinity();
  double relative = std::numeric_limits<double>::infinity();  ///< in local vessel radii

  double at(double radius) const { return std::min(mm, relative * radius); }
  bool is_set() const { return std::isfinite(mm) || std::isfinite(relative); }
};

/// "0.3mm", "10%" or "0.3mm,10%"; empty without a limit.
std::string to_string(const ErrorLimit& limit);
/// The reverse. Throws InvalidInput for any other text.
ErrorLimit parse_error_limit(std::string_view text);

/// Ends of a centerline (nodes with one segment) at which the surface is left open.
struct OpenEnds {
  bool all = false;
  std::vector<Index> nodes;  ///< these; ignored with `all`
};

/// Largest GenerateOptions::elongation: beyond it triangles would be nearly degenerate.
inline constexpr int kMostElongation = 16;

/// Bounds of GenerateOptions::ring_spacing.
inline constexpr double kLeastRingSpacing = 0.8, kMostRingSpacing = 1.25;

/// How a surface is grown and finished. Lengths are in units of the local vessel radius unless said otherwise.
struct GenerateOptions {
  /// Weight of the attraction by the vessel boundary against the vertex normal, Eq. 11; in [0, 1].
  double beta = 0.3;
  /// Width of the rounding at branches, in units of the smaller of the two radii; 0 = plain union of round cones.
  double blend = 0.5;
  /// Intended number of vertices around a vessel, 3 to 200: the size field is proportional to radius / around.
  int around = vertices_around(Preset::low);
  /// A grown face is split edge-centrically when its centre is farther than this from the boundary.
  double max_center_distance = 0.35;
  Placement placement = Placement::balanced;
  /// The surface is refined wherever it would be farther from the boundary. May raise `around`: see least_around().
  ErrorLimit max_error;
  /// Along vessels, triangles are as long as the error allows, at most this times what they are evenly, in
  /// [1, kMostElongation]; around junctions and ends they stay even. The error: what edges across the vessel cut off,
  /// or max_error. With that, unless deformable, vertices are then left out anywhere as long as it stays proven.
  /// Guided growth only.
  double elongation = 1;
  /// No more vertices are left out once this number is left: those that are left are where they reduce the mean error
  /// most. Without max_error, nothing is proven then, but no vertex is farther from the boundary than half the local
  /// radius. 0: as many are left out as max_error allows. Only with an elongation above 1, and not deformable.
  std::size_t least_vertices = 0;
  /// Between the numbers of vertices that whole numbers `around` give: rings along vessels lie farther apart or nearer
  /// by this factor than those of even triangles, in [kLeastRingSpacing, kMostRingSpacing], and edges at junctions and
  /// ends are longer by its square root. Near enough to 1 that triangles stay fairly even.
  double ring_spacing = 1;
  /// For a centerline that is to move: no node is left out by `simplification`, and triangles are no longer than the
  /// segments around, so that there is a ring of vertices at every node.
  bool deformable = false;
  /// Sweeps of the final optimisation; 0 leaves the surface as it was grown.
  int sweeps = 30;
  /// Nodes of the centerline are left out where that changes the vessels by at most this share of the distance that the
  /// surface keeps from them anyway, in [0, 1]; see simplify_for_growth(). 0: none. Guided growth only. Measured on 16
  /// trees that are not oversampled and six that are: the mean error of each changes by at most 2 % up to .35, and by
  /// at most 4 % up to 1.
  double simplification = 0.35;
  /// A centerline whose length and radii would need more vertices than this is refused.
  int max_vertices = 20'000'000;
  GrowthMethod growth = GrowthMethod::guided;
  /// Where the surface ends flat and open instead of in a hemisphere. Guided growth only.
  OpenEnds open_ends;
  /// Threads to work on; 0: as many as the machine has. The result does not depend on it.
  int threads = 0;
};

/// The centerline without the nodes that growth does not need, so that the cost depends on the surface, not on the
/// sampling of the input. The boundary moves nowhere by more than options.simplification times what edges across a
/// vessel cut off it, nor by more than a tenth of options.max_error.
SimplifiedCenterline simplify_for_growth(const Centerline& centerline, const GenerateOptions& options);

/// The options for a surface around the result of simplify_for_growth(): without further simplification, and with an
/// error limit that allows for what was changed, if anything.
GenerateOptions after_simplification(const GenerateOptions& options, const SimplifiedCenterline& simplified);

/// Where on the centerline a surface vertex belongs: segment and parameter in [0, 1] from its node a to its node b.
/// An isolated node i of the centerline (a sphere) is segment segments().size() + its rank among isolated nodes.
struct CenterlineBinding {
  Index segment = kNone;
  double t = 0;
};

/// Something that guided growth changed in the graph that steers it. The volume itself is unchanged.
struct GrowthSimplification {
  enum class Kind {
    merged_nodes,   ///< branching nodes with overlapping surroundings grew as one junction
    buried_branch,  ///< a branch that never leaves the volume of the others was left out
    filled_loop     ///< a loop too short to have a hole was filled
  };

  Kind kind;
  Vec3 position = Vec3::Zero();  ///< of the widest node, or in the middle of the branch
  std::vector<Index> nodes;      ///< of the centerline
  std::vector<Index> segments;   ///< of the centerline; for merged_nodes those of branches wholly within the junction
  std::string message;           ///< what was done, where and why
};

/// "merged_nodes", "buried_branch", "filled_loop".
std::string_view to_string(GrowthSimplification::Kind kind);

/// A piece of the surface that took far longer for a vertex than most.
struct SlowPiece {
  Vec3 position = Vec3::Zero();  ///< of its widest node or, without any, of a vertex; mm
  std::size_t vertices = 0;
  double seconds = 0;  ///< wall clock
  double times = 0;    ///< the median piece's time for a vertex
  std::string reason;  ///< what earlier tries ended with, or what the only one had to do
};

/// The graph that steered guided growth: junctions joined by tubes. The surface has its topology.
struct GrowthSummary {
  std::size_t junctions = 0;
  std::size_t tubes = 0;
  std::size_t components = 0;
  std::size_t cycle_rank = 0;  ///< the genus of the surface
  std::vector<GrowthSimplification> simplifications;
  std::size_t pieces = 0;          ///< number of pieces in which the surface was made
  std::vector<std::size_t> rungs;  ///< number of pieces by the rung of the ladder on which they were sound or given up
  RefusedSteps refused;            ///< of guarded steps, while pieces were made and vertices left out
  /// Pieces that took more than ten times the median piece's time for a vertex, slowest first. Times differ from run to
  /// run; with more than one thread they may contain those of pieces that were made meanwhile.
  std::vector<SlowPiece> slow_pieces;
};

/// A requested hole in the surface at an end of a vessel: a ring in the plane across the vessel through the end's node.
struct Opening {
  Index node = kNone;          ///< of the centerline
  Vec3 center = Vec3::Zero();  ///< position of the node, mm
  Vec3 normal = Vec3::Zero();  ///< out of the vessel
  double radius = 0;           ///< of the vessel there, mm
  std::vector<Index> ring;     ///< vertices, counter-clockwise about `normal`
};

/// Unit normal of the area of an opening's ring as seen from its centre.
Vec3 normal_of(const Opening& opening, const TriMesh& mesh);

/// Connected faces for which the error limit is not proven.
struct UnprovenPlace {
  Vec3 position = Vec3::Zero();  ///< of one of them, mm
  std::size_t faces = 0;
};

/// A notch, too narrow for triangles across it, that was closed up to some height above its end.
struct ClosedNotch {
  Vec3 position = Vec3::Zero();  ///< of the vertex farthest above the end, mm
  double depth = 0;              ///< how far above, mm; the error limit accounts for it
  std::size_t vertices = 0;      ///< number of vertices that close it
};

/// What is known of the distance between a surface and the boundary, both ways (see ErrorProof), if there is a limit.
/// At openings there is no boundary to compare with.
struct ErrorSummary {
  std::size_t unproven_faces = 0;              ///< 0: the limit holds everywhere
  std::vector<UnprovenPlace> unproven_places;  ///< largest first
  std::vector<ClosedNotch> closed_notches;     ///< deepest first
};

/// What simplify_for_growth() changed.
struct SimplificationSummary {
  std::size_t nodes_left_out = 0;
  double max_deviation = 0,
         max_deviation_relative = 0;  ///< of either boundary from the other, in mm and in local radii
};

/// Something about a surface that its user should know.
struct GrowthWarning {
  enum class Kind {
    filled_loop,       ///< loops of the centerline are too short to have a hole
    closed_end,        ///< an end that was to be left open could not be
    refused_faces,     ///< paper growth: faces crossed by the centerline too often were left as they are
    unclosed_loop,     ///< paper growth: a loop that a single seed cannot close
    forced_vertices,   ///< paper growth: vertices that did not reach the boundary by themselves
    crossing_faces,    ///< paper growth: faces of neighbouring vessels intersect each other
    stopped_refining,  ///< paper growth: far more vertices than were expected
  };

  Kind kind = Kind::filled_loop;
  std::size_t count = 0;  ///< number of occurrences
  std::string message;
};

/// "filled_loop", "closed_end", ...
std::string_view to_string(GrowthWarning::Kind kind);

/// A generated surface. Whatever went wrong is reported in `defects` and `warnings`.
struct GenerateResult {
  TriMesh mesh;
  std::vector<CenterlineBinding> binding;  ///< one per vertex
  std::vector<double> radius;              ///< local vessel radius at every vertex's binding (mm)
  /// How much longer than wide triangles may be at every vertex, along the vector; empty without
  /// GenerateOptions::elongation, zero where they are even. Vertices of extensions have none.
  std::vector<Vec3> elongation;
  std::vector<Opening> openings;  ///< ascending in the nodes
  ErrorSummary error;             ///< with max_error
  SimplificationSummary simplification;
  GrowthSummary growth;         ///< of guided growth; empty after paper growth
  std::vector<Defect> defects;  ///< none: the surface is sound
  SurfaceCheck check;           ///< the measurements behind `defects`
  std::vector<StageTime> stages;
  std::vector<GrowthWarning> warnings;

  bool is_sound() const { return defects.empty(); }
};

/// The surface with its openings closed by flat fans around their centres, one added vertex each. It bounds a volume.
TriMesh with_lids(const GenerateResult& result);

/// The value to which an error limit raises GenerateOptions::around: at least 4, as a triangular cross-section cannot
/// be refined; what a limit in local radii needs along a vessel; and enough that nowhere edges must be refined to less
/// than 1 / 1.8 of their length for a limit in mm: refined farther, faces fold.
int least_around(const Centerline& centerline, const ErrorLimit& limit);

/// Approximate number of vertices of a surface with even triangles, as measured on trees. With a limit on the error:
/// where that asks for finer triangles along straight vessels, with those.
double expected_vertices(const Centerline& centerline, double around, const ErrorLimit& limit = {});

/// Converts a surface around a simplified centerline to the original's numbers and notes what was left out. Nodes that
/// are not the original's (kNone) stay kNone.
void refer_to_original(const SimplifiedCenterline& simplified, GenerateResult& result);

/// The same for a surface around the result of separate_contacts(): added nodes are left out, or become kNone.
void refer_to_original(const SeparatedCenterline& separated, const Centerline& original, GenerateResult& result);

/// Grows a surface around `centerline` (paper, section 4) and optimises it. Deterministic. Throws InvalidInput for
/// options out of range and for a centerline too long for its radii, Unsupported if the surface would need more memory
/// than is free (see available_memory()), Cancelled when `progress` asks to stop.
GenerateResult generate_surface(const Centerline& centerline, const GenerateOptions& options = {},
                                const Progress& progress = {});

}  // namespace vmesh

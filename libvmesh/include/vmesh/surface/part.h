#pragma once

#include <functional>
#include <vector>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/progress.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/field_excerpt.h"

namespace vmesh {

/// Consecutive rings of a branch, with the vessel between and beyond them up to the next seam or the branch's end. A
/// seam is a ring at which the surface is divided: it stays as it was laid.
struct Stretch {
  Index branch = kNone;
  Index first = 0, count = 0;                        ///< its rings; along a loop the first follows the last
  bool seam_at_first = false, seam_at_last = false;  ///< whether its outer rings are seams

  auto operator<=>(const Stretch&) const = default;
};

/// The stretches and nodes around which a piece is grown.
struct PiecePlan {
  std::vector<Index> nodes;  ///< nodes where vessels branch or end, and isolated ones, ascending
  std::vector<Stretch> stretches;

  auto operator<=>(const PiecePlan&) const = default;
};

/// A ring of a branch by its number.
struct RingPlace {
  Index branch = kNone, ring = kNone;

  auto operator<=>(const RingPlace&) const = default;
};

/// Number of rungs on the ladder of ways to make a piece; see make_piece().
inline constexpr int kRungs = 8;

/// Why a piece is not sound.
struct PieceFault {
  DefectKind kind;
  Vec3 position = Vec3::Zero();
  double radius = 0;             ///< of the thinnest vessel there, mm
  bool vessels_overlap = false;  ///< another vessel covers the position: no surface could be sound
};

/// A part of a surface to be grown, self-contained: some of its pieces and what they need of the volume. Seams are the
/// same in every part.
struct SurfacePart {
  struct Seam {
    RingPlace place;       ///< along the part's branches
    Index number = kNone;  ///< in the whole
  };

  GenerateOptions options;       ///< of the whole surface, after settling
  FieldExcerpt field;            ///< numbered as in the centerline that was split
  std::vector<Branch> branches;  ///< branches along which its pieces lie, in nodes and segments of the excerpt
  Index first_piece = 0;         ///< number in the whole
  std::vector<PiecePlan> pieces;
  std::vector<Seam> seams;  ///< at the ends of its pieces, ascending in place and number
};

/// A grown part: a surface with holes at the seams around it. Vertices of all its seams come first, options.around for
/// each, then those of its pieces in their order.
struct PartSurface {
  struct Piece {
    Index vertex_count = 0, face_count = 0;
    Index junctions = 0, tubes = 0, filled_loops = 0;
    Index rung = 0;                  ///< of the ladder on which it was made
    RefusedSteps refused;            ///< of guarded steps on that rung
    double worst_skewness = 0;       ///< equiangle
    std::vector<PieceFault> faults;  ///< none: it is sound
  };

  Index first_piece = 0;
  Index around = 0;
  std::vector<Index> seams;  ///< numbers in the whole, ascending
  std::vector<Piece> pieces;
  TriMesh mesh;
  std::vector<CenterlineBinding> binding;  ///< one per vertex, like `radius`; refers to the centerline that was split
  std::vector<double> radius;
  std::vector<std::pair<Index, Index>> crossings;  ///< faces of different pieces that cross each other, ascending
  std::vector<GrowthSimplification> simplifications;

  Index seam_vertex_count() const { return static_cast<Index>(seams.size()) * around; }
};

/// How a surface was split.
struct SplitSummary {
  GenerateOptions options;  ///< as they were settled
  std::size_t parts = 0, pieces = 0, seams = 0;
  std::size_t components = 0, cycle_rank = 0;  ///< of the centerline that steers growth
  double expected_vertices = 0;
  std::vector<GrowthSimplification> simplifications;  ///< branches that were left out
};

/// Divides the surface that generate_surface() would grow into its pieces, and calls take(part) for parts of about
/// `vertices` vertices and at least one piece each, in order. A part contains the whole centerline of every branch that
/// it touches. Memory is that of the volume, not of the surface; the centerline is taken over because it may be large
/// and is dropped when it is not needed any more. All nodes steer the surface; see simplify_for_growth() for leaving
/// some out first. Throws like generate_surface(), and Unsupported for what needs the whole surface: paper growth, an
/// error limit, open ends.
SplitSummary split_surface(Centerline centerline, const GenerateOptions& options, double vertices,
                           const std::function<void(SurfacePart)>& take, const Progress& progress = {});

/// Grows the pieces of a part on `threads` threads (0: all); vertices and faces are those of the whole surface, to the
/// bit. Faults are reported with the pieces. Throws InvalidInput for an inconsistent part, Cancelled.
PartSurface grow_part(const SurfacePart& part, int threads, const Progress& progress = {});

/// The neighbourhood of crossing faces in a whole surface: all faces near them, in their order in the whole.
struct SurfaceAround {
  TriMesh mesh;
  std::vector<CenterlineBinding> binding;
  std::vector<double> radius;
};

/// Parts walls of different pieces that cross, as generate_surface() does: edges of such faces are flipped or split, or
/// vertices moved. Vertices and faces keep their numbers; new ones come last. `field`: the merged excerpts of all parts
/// nearby. Returns the pairs of faces that still cross.
std::vector<std::pair<Index, Index>> part_walls(SurfaceAround& surface, const FieldExcerpt& field,
                                                const std::vector<std::pair<Index, Index>>& crossings);

}  // namespace vmesh

#pragma once

#include <optional>
#include <vector>

#include "vmesh/core/progress.h"
#include "vmesh/surface/generate.h"

#include "surface/pieces/division.h"
#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// Whether `p` is inside a vessel that is not local to `cone`.
bool is_covered(const VesselField& field, const Vec3& p, Index cone);

/// A vertex of a seam: number `number` of its ring.
struct SeamVertex {
  RingPlace seam;
  Index number = 0;
};

/// What a try to make a piece failed with.
struct PieceTry {
  std::optional<DefectKind> fault;  ///< the first of its faults; nothing if a junction hung
  std::size_t faults = 0;
  double worst_skewness = 0;  ///< why it failed if there was no fault
};

/// What it took to make a piece: known also when its vertices have gone into the whole surface.
struct PieceWork {
  double seconds = 0;  ///< wall clock
  std::vector<PieceTry> failed;
  std::size_t vertices = 0, seam_vertices = 0;
  Vec3 position = Vec3::Zero();  ///< of one of them
};

/// A finished piece: grown, docked, optimised and checked. Faces refer to its own vertices and, from vertices.size()
/// on, to those of its seams.
struct PieceSurface {
  std::vector<Vec3> vertices;
  std::vector<CenterlineBinding> binding;  ///< one per own vertex, like `radius`
  std::vector<double> radius;
  std::vector<SeamVertex> seam_vertices;
  std::vector<Triangle> faces;
  struct Hole {
    Index node;
    std::vector<Index> vertices;  ///< counter-clockwise about the direction out of the vessel
  };
  std::vector<Hole> holes;  ///< at ends that are left open

  std::size_t junctions = 0, tubes = 0;
  std::vector<GrowthSimplification> simplifications;
  std::size_t filled_loops = 0;  ///< loops of the centerline too short to have a hole
  double worst_skewness = 0;     ///< equiangle, of its triangles
  int rung = 0;                  ///< of the ladder on which it was made
  RefusedSteps refused;          ///< on that rung
  PieceWork work;
  std::vector<PieceFault> faults;
  bool cannot_be_sound = false;  ///< some rung found overlapping vessels in it: it cannot be sound
};

/// What all pieces of a surface have in common.
struct PieceContext {
  const VesselRings& tubes;
  const std::vector<char>& open;  ///< for every node, whether the surface is to be open there
  const GenerateOptions& options;
  const Progress& progress;
  ErrorLimit refined_to = {};               ///< what the surface, which has no creases, is refined to later, if set
  std::vector<FinePlace> fine_places = {};  ///< see BoundSurface
  int most_rungs = kRungs;                  ///< of the ladder that are tried
};

/// Makes a piece on a ladder of kRungs rungs, cheapest first: the piece as planned; rings around its faults left to
/// junctions, over a growing distance; finer triangles around the faults; the same with guarded steps; everything from
/// one lattice. Returns the piece of the first rung on which it is sound and without bad triangles, else the one with
/// the fewest faults; without vertices if junctions hang on all of fewer rungs. Stops climbing once vessels are found
/// to overlap that are not local to each other.
PieceSurface make_piece(const PieceContext& context, const PiecePlan& plan);

}  // namespace vmesh

#include "surface/pieces/piece_invariants.h"

#include <algorithm>
#include <map>

#include "vmesh/core/execution.h"

namespace vmesh {
namespace {

// With lids, of the graph that the plan is a part of: two for every node or end less two for every stretch.
std::int64_t euler_characteristic(const RingCounts& rings, const PiecePlan& plan, std::size_t filled_loops) {
  auto nodes = static_cast<std::int64_t>(plan.nodes.size() + filled_loops);
  for (const Stretch& stretch : plan.stretches) {
    nodes += stretch.seam_at_first + stretch.seam_at_last;
    if (rings.is_loop(stretch.branch) && !stretch.seam_at_first && !stretch.seam_at_last) ++nodes;  // closed in itself
  }
  return 2 * (nodes - static_cast<std::int64_t>(plan.stretches.size()));
}

}  // namespace

PieceInvariants::PieceInvariants(const VesselRings& tubes, const PiecePlan& plan, std::size_t filled_loops,
                                 const BoundSurface& surface, const std::vector<PieceLoop>& loops)
    : on_(execution_params().intermediate_checks) {
  if (!on_) return;
  euler_characteristic_ = euler_characteristic(RingCounts(tubes), plan, filled_loops);
  for (const PieceLoop& loop : loops) {
    for (const Vertex v : loop.vertices) {
      if (loop.node == kNone) at_seams_.emplace_back(v, surface.position(v));
    }
  }
}

void PieceInvariants::check(const BoundSurface& surface) const {
  if (!on_) return;
  surface.require_closed("a piece");
  const SurfaceMesh& mesh = surface.mesh;
  const auto euler = static_cast<std::int64_t>(mesh.number_of_vertices()) -
                     static_cast<std::int64_t>(mesh.number_of_edges()) +
                     static_cast<std::int64_t>(mesh.number_of_faces());
  require_invariant(euler == euler_characteristic_, "a piece has an Euler characteristic of " + std::to_string(euler) +
                                                        ", its part of the centerline " +
                                                        std::to_string(euler_characteristic_));
  for (const auto& [v, p] : at_seams_)
    require_invariant(surface.position(v) == p && surface.held(v), "a vertex of a seam has moved");
}

void check_division(const RingCounts& rings, const Division& division) {
  if (!execution_params().intermediate_checks) return;
  std::map<RingPlace, std::vector<std::size_t>> pieces_at;
  for (std::size_t p = 0; p < division.plans.size(); ++p) {
    for (const RingPlace& seam : seams_of(rings, division.plans[p])) pieces_at[seam].push_back(p);
  }
  for (const RingPlace& seam : division.seams) {
    const std::vector<std::size_t>& pieces = pieces_at[seam];
    require_invariant(pieces.size() == 2 && pieces[0] != pieces[1],
                      "a seam of branch " + std::to_string(seam.branch) + " does not lie between two pieces");
  }
  require_invariant(pieces_at.size() == division.seams.size(), "a piece ends at a seam that there is not");
}

void check_numbers(const PieceSurface& piece) {
  if (!execution_params().intermediate_checks) return;
  const std::size_t own = piece.vertices.size(), all = own + piece.seam_vertices.size();
  require_invariant(piece.binding.size() == own && piece.radius.size() == own, "a vertex of a piece has no place");
  for (const Triangle& face : piece.faces) {
    require_invariant(std::all_of(face.begin(), face.end(), [&](Index v) { return v < all; }),
                      "a face of a piece has a corner that there is not");
  }
}

void check_repeatable(const PieceSurface& piece, const PieceSurface& again) {
  require_invariant(piece.vertices == again.vertices && piece.faces == again.faces && piece.radius == again.radius &&
                        piece.rung == again.rung,
                    "a piece made twice is not the same");
}

}  // namespace vmesh

#include "surface/pieces/piece.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "vmesh/core/execution.h"

#include "surface/finish/optimize.h"
#include "surface/junction/docked_junction.h"
#include "surface/pieces/assembly.h"
#include "surface/pieces/piece_check.h"
#include "surface/pieces/piece_invariants.h"
#include "surface/pieces/whole_tasks.h"
#include "surface/remesh/mend.h"

namespace vmesh {
namespace {

// What a rung does about the faults of the previous one.
struct Rung {
  double reach;  // radii: rings this near to a fault are left to a junction; 0: none
  double finer;  // radius of fine spots at faults, relative to that of the thinnest vessel there; 0: none
  bool guarded;  // no step is taken after which faces cross
};
// Skewness above which triangles are mended at any cost except soundness; safe 0.35 to 0.5, above not sound.
constexpr double kMended = 0.5;
// Skewness above which triangles are improved. Measured on seven trees: the maximum skewness follows it (0.25 gives
// 0.253 on average, 0.235 gives 0.238, without it 0.314), the mean grows by 1 %, and all take 8 to 15 % longer.
constexpr double kImproveAbove = 0.24;
// Radii around faults within which guarded rungs do not refine for the error limit: the boundary may have a step there,
// at which finer triangles prove nothing and stand on edge.
constexpr double kCalm = 2;       // idle 1.4 to 2.8
constexpr int kFirstGuarded = 4;  // of the rungs below: where a hub starts; idle 3 to 6
// Free rings next to a hub that are left to it: of 250 branches; of others as many more as it takes for the same gap,
// which opens like the inverse square root of their number. Measured on short stars (bench/README.md): of 500, with 0,
// rims cross; of 1,000, with 2, with 4 none do.
constexpr double kRoomAtHub = 2, kBranchesAtHub = 250;  // kRoomAtHub: idle 1 to 3
constexpr double kEverywhere = std::numeric_limits<double>::infinity();
constexpr Rung kLadder[kRungs] = {{0, 0, false}, {2, 0, false}, {3, 0, false},  {3, 1, false},
                                  {3, 0, true},  {3, 1, true},  {5, 0.5, true}, {kEverywhere, 0.5, true}};

std::string at(const Vec3& p) {
  std::ostringstream text;
  text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
  return text.str();
}

// Notes the parts of the centerline's graph that growing this junction as a whole leaves out.
void note_simplifications(const VesselRings& tubes, const Junction& junction, std::size_t filled_loops,
                          std::vector<GrowthSimplification>& notes) {
  const Centerline& centerline = tubes.centerline();
  GrowthSimplification note;
  std::size_t inner_branches = 0;
  note.nodes = junction.nodes;
  for (const BareStretch& bare : junction.bare_stretches) {
    if (bare.docks[0].tube != kNone || bare.docks[1].tube != kNone) continue;
    const auto& segments = tubes.axes()[bare.branch].branch().segments;
    note.segments.insert(note.segments.end(), segments.begin(), segments.end());
    ++inner_branches;
  }
  double widest = 0;
  for (const Index n : junction.nodes) {
    if (centerline.node(n).radius <= widest) continue;
    widest = centerline.node(n).radius;
    note.position = centerline.node(n).position;
  }
  if (junction.nodes.empty()) {
    const BareStretch& bare = junction.bare_stretches.front();
    note.position = tubes.axes()[bare.branch].at(bare.begin).position;
  }
  if (junction.nodes.size() > 1) {
    note.kind = GrowthSimplification::Kind::merged_nodes;
    note.message = std::to_string(junction.nodes.size()) + " nodes around " + at(note.position) +
                   " grew as one junction: nowhere between them does a vessel have a cross-section of its own; " +
                   std::to_string(inner_branches) + " branches lie wholly within it";
    notes.push_back(note);
  }
  if (filled_loops > 0) {
    note.kind = GrowthSimplification::Kind::filled_loop;
    note.message = std::to_string(filled_loops) + " loops around " + at(note.position) +
                   " are too short to have a hole; the surface is filled there";
    notes.push_back(note);
  }
}

// Number of faults, then the worst skewness if it is bad.
using Badness = std::pair<std::size_t, double>;
constexpr Badness kNoBadness{0, 0};

bool vessels_overlap(const std::vector<PieceFault>& faults) {
  return std::any_of(faults.begin(), faults.end(), [](const PieceFault& fault) { return fault.vessels_overlap; });
}

Badness badness(const PieceSurface& piece, double mended) {
  return {piece.faults.size(), piece.worst_skewness > mended ? piece.worst_skewness : 0};
}

constexpr std::size_t kMadeTwice = 1000;  // vertices, of smaller pieces: with intermediate checks

class PieceMaker {
 public:
  PieceMaker(const PieceContext& context, const PiecePlan& plan)
      : context_(context), tubes_(context.tubes), plan_(plan) {}

  PieceSurface run() {
    std::optional<PieceSurface> best;
    std::vector<PieceFault> last;
    std::vector<PieceTry> failed;
    const int first = is_hub() ? kFirstGuarded : 0;
    leave_room_at_hubs();
    const int end = std::min(kRungs, first + context_.most_rungs);
    for (int rung = first; rung < end; ++rung) {
      if (rung > 0 && !climb(kLadder[rung], last)) continue;
      std::optional<PieceSurface> piece = make(kLadder[rung], last);
      if (!piece) {
        failed.push_back({{}, last.size(), 0});
        continue;
      }
      piece->rung = rung;
      last = piece->faults;
      const bool cannot_be_sound = vessels_overlap(last);
      const double worst = piece->worst_skewness;
      if (!best || badness(*piece, mended()) < badness(*best, mended())) best = std::move(piece);
      best->cannot_be_sound = cannot_be_sound && !best->faults.empty();
      if (badness(*best, mended()) == kNoBadness || cannot_be_sound) break;
      failed.push_back({last.empty() ? std::nullopt : std::optional(last.front().kind), last.size(), worst});
    }
    if (!best && end < kRungs) best.emplace().faults = last;
    if (!best) best = make_hanging();
    best->work.failed = std::move(failed);
    return *std::move(best);
  }

 private:
  // Skewness above which triangles are mended. Mending moves vertices off the boundary a little, so with an error limit
  // only the unsound ones are.
  double mended() const { return context_.options.max_error.is_set() ? kWorstSkewness : kMended; }

  std::size_t most_branches() const {
    std::size_t most = 0;
    for (const Index n : plan_.nodes) most = std::max<std::size_t>(most, tubes_.centerline().degree(n));
    return most;
  }
  // Where very many vessels meet at a node, some walls always nearly touch.
  bool is_hub() const { return most_branches() >= kHub; }
  bool is_crowded() const { return most_branches() > kUncrowded; }

  static int room_at_hub(std::size_t branches) {
    return static_cast<int>(std::ceil(kRoomAtHub * std::sqrt(static_cast<double>(branches) / kBranchesAtHub)));
  }

  // Where very many vessels part, the rounding between them ends in webs just where the first rings are free.
  void leave_room_at_hubs() {
    for (const Stretch& stretch : plan_.stretches) {
      const std::span<const Ring> rings = tubes_.rings(stretch.branch);
      const std::vector<Index>& nodes = tubes_.axes()[stretch.branch].branch().nodes;
      for (const bool at_end : {false, true}) {
        if (at_end ? stretch.seam_at_last : stretch.seam_at_first) continue;
        const std::size_t branches = tubes_.centerline().degree(at_end ? nodes.back() : nodes.front());
        if (branches < kHub) continue;
        int left = room_at_hub(branches);
        for (Index k = 0; k < stretch.count && left > 0; ++k) {
          const auto number = static_cast<Index>((stretch.first + (at_end ? stretch.count - 1 - k : k)) % rings.size());
          if (!rings[number].free) continue;
          covered_.push_back({stretch.branch, number});
          --left;
        }
      }
    }
    std::sort(covered_.begin(), covered_.end());
  }

  // Applies a rung; returns whether it changes anything about how the piece was made last.
  bool climb(const Rung& rung, const std::vector<PieceFault>& faults) {
    const std::size_t before = covered_.size() + fine_spots_.size() + calm_spots_.size();
    const bool newly_guarded = rung.guarded && !guarded_;
    guarded_ = rung.guarded;
    if (rung.finer > 0) {
      for (const PieceFault& fault : faults) fine_spots_.push_back({fault.position, rung.finer * fault.radius});
    }
    if (rung.guarded && context_.options.max_error.is_set()) {
      for (const PieceFault& fault : faults) calm_spots_.push_back({fault.position, kCalm * fault.radius});
    }
    for (const Stretch& stretch : plan_.stretches) {
      const std::span<const Ring> rings = tubes_.rings(stretch.branch);
      for (Index k = 0; k < stretch.count; ++k) {
        const auto number = static_cast<Index>((stretch.first + k) % rings.size());
        const Ring& ring = rings[number];
        const double reach = rung.reach * ring.radius;
        const bool near = std::any_of(faults.begin(), faults.end(), [&](const PieceFault& fault) {
          return (fault.position - ring.center).squaredNorm() < reach * reach;
        });
        if (near && ring.free) covered_.push_back({stretch.branch, number});
      }
    }
    std::sort(covered_.begin(), covered_.end());
    covered_.erase(std::unique(covered_.begin(), covered_.end()), covered_.end());
    return covered_.size() + fine_spots_.size() + calm_spots_.size() > before || newly_guarded;
  }

  // Where junctions hang or are hopeless on every rung, what guarded steps make of them.
  PieceSurface make_hanging() {
    may_hang_ = true;
    std::vector<PieceFault> none;
    PieceSurface piece = *make({0, 0, true}, none);
    piece.rung = kRungs - 1;
    return piece;
  }

  // Nothing where a junction hangs or is hopeless: its vertices off the boundary or in tangles are the faults then.
  std::optional<PieceSurface> make(const Rung& rung, std::vector<PieceFault>& unusable) {
    const GrowthSkeleton skeleton = make_growth_skeleton(tubes_, plan_, covered_);
    PieceSurface piece;
    piece.junctions = skeleton.junctions.size();
    piece.tubes = skeleton.tubes.size();
    Assembly assembly(tubes_, plan_, skeleton, context_.open);
    const auto docked = docked_junctions(skeleton, rung.guarded);
    if (!may_hang_ && list_unusable(docked, unusable)) return std::nullopt;
    for (std::size_t j = 0; j < skeleton.junctions.size(); ++j) {
      const Junction& junction = skeleton.junctions[j];
      const DockedJunction& grown = **docked[j];
      assembly.add_junction(junction, grown);
      piece.filled_loops += grown.filled_loops;
      note_simplifications(tubes_, junction, grown.filled_loops, piece.simplifications);
    }
    BoundSurface surface(tubes_.field());
    surface.elongation_field = tubes_.elongation_field();
    const std::vector<PieceLoop> loops = assembly.build(surface);
    const PieceInvariants invariants(tubes_, plan_, piece.filled_loops, surface, loops);
    if (rung.guarded) surface.guard_crossings();
    surface.crowded = is_crowded();
    if (rung.finer > 0) surface.fine_spots = fine_spots_;
    surface.calm_spots = calm_spots_;
    surface.refined_to = context_.refined_to;
    surface.fine_places = context_.fine_places;
    bool tested = false;  // and found that no faces cross
    if (context_.options.sweeps > 0) {
      const GrownMesh grown{double(context_.options.around),
                            expected_vertices(length_in_radii(), context_.options.around), GrownMesh::Stage::assembled};
      const OptimizeReport report = optimize(surface, context_.options, grown, context_.progress);
      const bool crosses = report.crosses;
      tested = !report.hopeless && !mend_worst_faces(surface, mended(), context_.progress) && !crosses;
      // Guarded: improving adds no crossings. Not with an error limit: faces that are already proven would move.
      if (!crosses && !context_.options.max_error.is_set())
        improve_worst_faces(surface, kImproveAbove, context_.progress);
    }
    const PieceFindings findings = check_piece(surface, nodes_of(skeleton), context_.options, !tested);
    piece.faults = findings.faults;
    piece.worst_skewness = findings.worst_skewness;
    piece.refused = surface.refused();
    invariants.check(surface);
    export_surface(surface, loops, piece);
    check_numbers(piece);
    return piece;
  }

  static bool list_unusable(const std::vector<const std::optional<DockedJunction>*>& docked,
                            std::vector<PieceFault>& faults) {
    std::vector<PieceFault> found;
    for (const auto* grown : docked) {
      for (const auto* spots : {&(*grown)->hanging, &(*grown)->hopeless}) {
        for (const auto& [position, radius] : *spots)
          found.push_back({DefectKind::crossing_faces, position, radius, false});
      }
    }
    if (found.empty()) return false;
    faults = std::move(found);
    return true;
  }

  // Junctions that a rung leaves unchanged are not grown again.
  std::vector<const std::optional<DockedJunction>*> docked_junctions(const GrowthSkeleton& skeleton, bool guarded) {
    std::vector<const std::optional<DockedJunction>*> docked;
    std::vector<std::pair<const Junction*, GrownJunction*>> missing;
    for (const Junction& junction : skeleton.junctions) {
      GrownJunction& known = grown_[key_of(skeleton, junction)];
      const bool given_up = known.docked && !known.docked->hanging.empty();
      const bool will_do =
          known.docked && (given_up ? !may_hang_ : known.guarded || !guarded || known.docked->tangles == 0);
      if (!will_do) missing.emplace_back(&junction, &known);
      docked.push_back(&known.docked);
    }
    for_whole_tasks(missing.size(), [&](std::size_t i) {
      const auto& [junction, known] = missing[i];
      known->docked = make_docked_junction(tubes_, skeleton, *junction, context_.options, context_.fine_places, guarded,
                                           may_hang_, context_.progress);
      known->guarded = guarded;
    });
    return docked;
  }

  // Everything a junction's surface depends on: its nodes, its bare stretches, and how many rings it replaces at each
  // of their ends.
  static std::vector<double> key_of(const GrowthSkeleton& skeleton, const Junction& junction) {
    std::vector<double> key(junction.nodes.begin(), junction.nodes.end());
    for (const BareStretch& bare : junction.bare_stretches) {
      key.insert(key.end(), {-1.0 - bare.branch, bare.begin, bare.end});
      for (const TubeEnd& dock : bare.docks)
        key.push_back(dock.tube == kNone ? -1.0 : static_cast<double>(rings_given_away(skeleton.tubes[dock.tube])));
    }
    return key;
  }

  double length_in_radii() const {
    double rings = 0;  // if they lay evenly
    for (const Stretch& stretch : plan_.stretches) {
      const std::span<const Ring> all = tubes_.rings(stretch.branch);
      for (Index k = 0; k < stretch.count; ++k) rings += all[(stretch.first + k) % all.size()].elongation;
    }
    return (rings + 2 * static_cast<double>(plan_.nodes.size())) * RingOptions::of(context_.options).pitch();
  }

  // Nodes that must lie inside: all except those right at a seam.
  std::vector<Index> nodes_of(const GrowthSkeleton& skeleton) const {
    std::vector<Index> nodes = plan_.nodes;
    for (std::size_t i = 0; i < plan_.stretches.size(); ++i) {
      const Stretch& stretch = plan_.stretches[i];
      const BranchAxis& axis = tubes_.axes()[stretch.branch];
      const std::vector<Ring>& rings = skeleton.rings[i];
      double low = stretch.seam_at_first ? rings.front().place + rings.front().radius : 0;
      double high = stretch.seam_at_last ? rings.back().place - rings.back().radius : axis.length();
      const bool around = axis.periodic() && stretch.seam_at_first && rings.front().place >= rings.back().place;
      for (std::size_t n = 1; n + 1 < axis.branch().nodes.size() || (axis.periodic() && n < axis.branch().nodes.size());
           ++n) {
        const double place = axis.node_place(n);
        if (around ? place > low || place < high : place > low && place < high) nodes.push_back(axis.branch().nodes[n]);
      }
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::erase_if(nodes, [&](Index n) { return context_.open[n] != 0; });
    return nodes;
  }

  void export_surface(const BoundSurface& surface, const std::vector<PieceLoop>& loops, PieceSurface& piece) const {
    const SurfaceMesh& mesh = surface.mesh;
    std::vector<Index> number(mesh.num_vertices() + mesh.number_of_removed_vertices(), kNone);
    std::map<Vertex, SeamVertex> at_seam;
    for (const PieceLoop& loop : loops) {
      for (Index j = 0; loop.node == kNone && j < loop.vertices.size(); ++j)
        at_seam.emplace(loop.vertices[j], SeamVertex{loop.seam, j});
    }
    // Exact sizes: all pieces are in memory at once.
    piece.vertices.reserve(mesh.number_of_vertices());
    piece.binding.reserve(mesh.number_of_vertices());
    piece.radius.reserve(mesh.number_of_vertices());
    piece.faces.reserve(mesh.number_of_faces());
    for (const Vertex v : mesh.vertices()) {
      if (surface[v].role == BoundSurface::Role::lid || at_seam.contains(v)) continue;
      number[v.idx()] = static_cast<Index>(piece.vertices.size());
      piece.vertices.push_back(surface.position(v));
      piece.binding.push_back({surface[v].cone, surface[v].t});
      piece.radius.push_back(surface.radius(v));
    }
    for (const auto& [v, seam] : at_seam) {
      number[v.idx()] = static_cast<Index>(piece.vertices.size() + piece.seam_vertices.size());
      piece.seam_vertices.push_back(seam);
    }
    for (const Face f : mesh.faces()) {
      if (surface.is_lid(f)) continue;
      const Halfedge h = mesh.halfedge(f);
      piece.faces.push_back(
          {number[mesh.source(h).idx()], number[mesh.target(h).idx()], number[mesh.target(mesh.next(h)).idx()]});
    }
    for (const PieceLoop& loop : loops) {
      if (loop.node == kNone) continue;
      PieceSurface::Hole hole{loop.node, {}};
      for (const Vertex v : loop.vertices) hole.vertices.push_back(number[v.idx()]);
      piece.holes.push_back(std::move(hole));
    }
  }

  const PieceContext& context_;
  const VesselRings& tubes_;
  const PiecePlan& plan_;
  std::vector<RingPlace> covered_;
  std::vector<BoundSurface::Spot> fine_spots_, calm_spots_;
  bool guarded_ = false;  // on the last rung
  bool may_hang_ = false;
  struct GrownJunction {
    std::optional<DockedJunction> docked;
    bool guarded = false;
  };
  std::map<std::vector<double>, GrownJunction> grown_;
};

}  // namespace

PieceSurface make_piece(const PieceContext& context, const PiecePlan& plan) {
  const auto start = std::chrono::steady_clock::now();
  PieceSurface piece = PieceMaker(context, plan).run();
  PieceWork& work = piece.work;
  work.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  work.vertices = piece.vertices.size();
  work.seam_vertices = piece.seam_vertices.size();
  if (!piece.vertices.empty()) work.position = piece.vertices.front();
  if (execution_params().intermediate_checks && piece.vertices.size() < kMadeTwice)
    check_repeatable(piece, PieceMaker(context, plan).run());
  return piece;
}

}  // namespace vmesh

#include "surface/junction/docked_junction.h"

#include <optional>
#include <span>

#include "surface/finish/optimize.h"
#include "surface/junction/junction_growth.h"
#include "surface/remesh/edge_lengths.h"
#include "surface/remesh/untangle.h"
#include "surface/tubes/stitch.h"

namespace vmesh {
namespace {

constexpr std::size_t kRingsGivenAway = 2;  // at most, at each end of a tube; safe 1 to 3

// How a junction's surface is made, tried in this order. Of 1,794 junctions of random trees, the first was clean for
// 1,762, the second for 19 and the third for two.
struct Variant {
  double finer;         ///< resolution of the junction's surface, relative to the requested one
  bool smooth_rims;     ///< see JunctionGrowth::make()
  bool guarded;         ///< no step is taken after which faces cross
  double fineness = 1;  ///< factor on the target edge length after docking
};
constexpr Variant kVariants[] = {{1, true, false}, {1.5, true, false}, {1.5, true, false, 0.67}, {2, true, false, 0.5}};
constexpr Variant kGuardedVariants[] = {{1, true, false}, {1, true, true}, {1, false, true}};
// Measured on stars of 250, 500 and 1,000 branches: no variant brings every vertex onto the boundary; rims left as cut
// do not cross.
constexpr Variant kHubVariants[] = {{1, false, true}, {1, true, true}};

std::span<const Variant> variants_of(bool guarded, bool hub) {
  if (hub) return kHubVariants;
  return guarded ? std::span<const Variant>(kGuardedVariants) : std::span<const Variant>(kVariants);
}

class JunctionDocker {
 public:
  JunctionDocker(const VesselRings& tubes, const GrowthSkeleton& skeleton, const JunctionGrowth& growth,
                 const std::vector<TubeEnd>& docks, const GenerateOptions& options, bool may_hang,
                 const Progress& progress)
      : skeleton_(skeleton),
        growth_(growth),
        docks_(docks),
        options_(options),
        may_hang_(may_hang),
        progress_(progress),
        surface_(tubes.field()) {
    surface_.elongation_field = tubes.elongation_field();
  }

  DockedJunction make(const Variant& variant) {
    const JunctionSurface junction = growth_.make(variant.finer, variant.smooth_rims, variant.guarded);
    add(junction.patch);
    for (const Vertex v : surface_.mesh.vertices()) surface_[v].fineness = variant.fineness;
    for (Index i = 0; i < docks_.size(); ++i) dock(i, junction.rims[i]);
    if (variant.guarded) surface_.guard_crossings();
    surface_.crowded = growth_.is_crowded();
    surface_.fine_places = growth_.fine_places();
    DockedJunction docked;
    docked.filled_loops = growth_.filled_loops();
    finish(variant.fineness, docked);
    export_to(docked);
    return docked;
  }

 private:
  void add(const SurfacePatch& patch) {
    vertex_.assign(patch.vertices.size(), SurfaceMesh::null_vertex());
    for (const Triangle& face : patch.faces) {
      for (const Index v : face) {
        if (vertex_[v] == SurfaceMesh::null_vertex())
          vertex_[v] = add_vertex(patch.vertices[v].position, patch.vertices[v].cone);
      }
    }
    for (const auto& [a, b, c] : patch.faces) add_face(vertex_[a], vertex_[b], vertex_[c]);
  }

  // Joins the rim to the outermost ring of the tube's end, that ring to the next, and so on up to the kept ring.
  void dock(Index number_of_dock, const std::vector<Index>& rim) {
    const TubeEnd& dock = docks_[number_of_dock];
    const Tube& tube = skeleton_.tubes[dock.tube];
    std::vector<Vertex> last;
    for (const Index v : rim) last.push_back(vertex_[v]);
    const std::size_t count = rings_given_away(tube) + 1;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t number = dock.at_end ? tube.rings.size() - 1 - k : k;
      std::vector<Vertex> ring;
      for (const RingPoint& p : tube.rings[number].points) {
        ring.push_back(add_vertex(p.position, p.cone));
        if (is_seam(tube, number)) surface_[ring.back()].lift = surface_[ring.back()].distance;
      }
      if (k + 1 == count) kept_.push_back({number_of_dock, ring});
      if (dock.at_end) std::reverse(ring.begin(), ring.end());
      band(last, ring);
      last = std::move(ring);
      if (k + 1 == count) surface_.close_with_lid(last, tube.rings[number].center);
    }
  }

  Vertex add_vertex(const Vec3& position, Index cone) {
    const Vertex v = surface_.mesh.add_vertex(position);
    surface_.place(v, position, surface_.field.sample_fast(position, cone));
    return v;
  }

  void add_face(Vertex a, Vertex b, Vertex c) {
    if (surface_.mesh.add_face(a, b, c) == SurfaceMesh::null_face())
      throw std::logic_error("the surfaces of a junction and its tubes are inconsistent");
  }

  void band(const std::vector<Vertex>& bottom, const std::vector<Vertex>& top) {
    const auto vertex = [&](Index i) { return i < bottom.size() ? bottom[i] : top[i - bottom.size()]; };
    for (const auto& [a, b, c] : stitch(positions(bottom), positions(top))) add_face(vertex(a), vertex(b), vertex(c));
  }

  std::vector<Vec3> positions(const std::vector<Vertex>& loop) const {
    std::vector<Vec3> result;
    for (const Vertex v : loop) result.push_back(surface_.position(v));
    return result;
  }

  void finish(double fineness, DockedJunction& docked) {
    if (options_.sweeps == 0) {
      docked.tangles = find_tangles(SweepState(surface_)).size();
      return;
    }
    const double radii = growth_.length_in_radii() + static_cast<double>(docks_.size() * (kRingsGivenAway + 1));
    const double finer = edge_length_per_radius(growth_.docked_around()) / edge_length_per_radius(options_.around);
    const double added = (finer * finer - 1) * surface_.mesh.number_of_vertices();
    const GrownMesh grown{double(growth_.docked_around()), added + expected_vertices(radii, options_.around / fineness),
                          GrownMesh::Stage::piece};
    const OptimizeReport report = optimize(surface_, options_, grown, progress_);
    docked.tangles = report.tangles;
    docked.unproven = report.unproven.size();
    if (report.tangles == 0) return;
    find_hanging(docked);
    if (report.hopeless && docked.hanging.empty()) docked.hopeless = spots_of(find_tangles(SweepState(surface_)));
    if (docked.hanging.empty() || may_hang_) docked.crossings = find_crossing_walls(SweepState(surface_)).size();
  }

  void find_hanging(DockedJunction& docked) {
    const SweepState state(surface_);
    const std::vector<Vertex> strays = find_strays(state);
    if (hangs(state, strays)) docked.hanging = spots_of(strays);
  }

  std::vector<BoundSurface::Spot> spots_of(const std::vector<Vertex>& vertices) const {
    std::vector<BoundSurface::Spot> spots;
    for (const Vertex v : vertices) spots.push_back({surface_.position(v), surface_.radius(v)});
    return spots;
  }

  void export_to(DockedJunction& docked) const {
    const SurfaceMesh& mesh = surface_.mesh;
    std::vector<Index> number(mesh.num_vertices() + mesh.number_of_removed_vertices(), kNone);
    for (const Vertex v : mesh.vertices()) {
      if (surface_[v].role == BoundSurface::Role::lid) continue;
      number[v.idx()] = static_cast<Index>(docked.vertices.size());
      docked.vertices.push_back({surface_.position(v), surface_[v].cone, surface_[v].fineness, surface_[v].lift, kNone,
                                 0, surface_[v].elongation_share});
    }
    for (const auto& [dock, vertices] : kept_) {
      for (Index j = 0; j < vertices.size(); ++j) {
        DockedVertex& v = docked.vertices[number[vertices[j].idx()]];
        v.dock = dock;
        v.number = j;
      }
    }
    for (const Face f : mesh.faces()) {
      if (surface_.is_lid(f)) continue;
      const Halfedge h = mesh.halfedge(f);
      docked.faces.push_back(
          {number[mesh.source(h).idx()], number[mesh.target(h).idx()], number[mesh.target(mesh.next(h)).idx()]});
    }
  }

  struct KeptRing {
    Index dock;
    std::vector<Vertex> vertices;  // in the order of the ring
  };

  const GrowthSkeleton& skeleton_;
  const JunctionGrowth& growth_;
  const std::vector<TubeEnd>& docks_;
  const GenerateOptions& options_;
  const bool may_hang_;
  const Progress& progress_;
  BoundSurface surface_;
  std::vector<Vertex> vertex_;  // of the junction's vertices
  std::vector<KeptRing> kept_;
};

}  // namespace

std::size_t rings_given_away(const Tube& tube) {
  const bool to_seam = tube.starts_at_seam || tube.ends_at_seam;
  return std::min(kRingsGivenAway, to_seam ? tube.rings.size() - 1 : (tube.rings.size() - 1) / 2);
}

Index kept_ring(const Tube& tube, bool at_end) {
  const std::size_t given = rings_given_away(tube);
  return static_cast<Index>(at_end ? tube.rings.size() - 1 - given : given);
}

DockedJunction make_docked_junction(const VesselRings& tubes, const GrowthSkeleton& skeleton, const Junction& junction,
                                    const GenerateOptions& options, const std::vector<FinePlace>& fine_places,
                                    bool guarded, bool may_hang, const Progress& progress) {
  const VesselField& field = tubes.field();
  const std::vector<TubeEnd> docks = docks_of(junction);
  const auto flaws = [](const DockedJunction& p) {
    return std::tuple(!p.hopeless.empty(), p.crossings, p.tangles, p.unproven);
  };
  std::optional<DockedJunction> best;
  const JunctionGrowth growth(field, tubes.axes(), skeleton, junction, options, fine_places, progress);
  // When guarded, refinement for the error limit is left to the whole piece.
  GenerateOptions own_options = options;
  if (guarded) own_options.max_error = {};
  const bool hub = guarded && docks.size() >= kHub;
  for (const Variant& variant : variants_of(guarded, hub)) {
    DockedJunction docked =
        JunctionDocker(tubes, skeleton, growth, docks, own_options, may_hang, progress).make(variant);
    if (!best || flaws(docked) < flaws(*best)) best = std::move(docked);
    if ((best->tangles == 0 && best->unproven == 0) || (!may_hang && !best->hanging.empty())) break;
    if (hub && best->crossings == 0) break;
  }
  return *std::move(best);
}

}  // namespace vmesh

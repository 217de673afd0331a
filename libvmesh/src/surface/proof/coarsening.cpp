#include "surface/proof/coarsening.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>

#include "surface/proof/coarsening_steps.h"
#include "surface/proof/kept_proof.h"

namespace vmesh {
namespace {

// Not in the surveys of libvmesh/README.md, but changed as those of coarsening_steps.cpp, with the same outcome.
constexpr double kSkewest = 0.75;  // with a limit; 0.85: as many vertices
// With a number of vertices. Faces above 0.9 count as defects. Nine trees with 0.75: 1.5 % more mean error.
constexpr double kSkewestOfFew = 0.86;
// Of the edges that may be collapsed: the cheapest are taken together, as far as they are apart.
constexpr double kBatch = 0.1;
constexpr double kBatchOfFew = 0.04;  // down to a number, when the order matters more
constexpr std::size_t kLeastBatch = 8;
constexpr int kRounds = 5, kRoundsWithLimit = 24;
constexpr int kExchanges = 6;  // 8 and 16: at most 0.3 % less mean error
// At the end. With a limit they leave out no vertices, and each step is proven.
constexpr int kRelaxations = 6, kRelaxationsWithLimit = 3;
// Of the vertices: not worth another round. Late rounds are cheap, as only what has changed is looked at. With a limit,
// 0.02 and 12 rounds, on two veins: 2 to 8 % more vertices in .9 to 1 of the time.
constexpr double kFewSteps = 0.02, kFewStepsWithLimit = 0.01;
// An edge is split if that gains this multiple of what leaving out a vertex costs: less than once, as flips and moves
// follow. 0.25 and 1: mean error within 0.7 %.
constexpr double kPays = 0.5;
constexpr std::size_t kEdgesPerVertex = 4;  // collapses nearby that one makes worse; the cheapest are often neighbours

constexpr double kNever = std::numeric_limits<double>::infinity();

// Steps that are taken together must not share a face around the vertices of those that they replace: then none changes
// what another one does, nor its proof.
class Claims {
 public:
  explicit Claims(const SurfaceMesh& mesh) : mesh_(mesh) {}

  void clear() {
    ++round_;
    claimed_.resize(mesh_.num_faces(), 0);
  }

  bool is_free(Vertex v) const {
    const auto around = mesh_.faces_around_target(mesh_.halfedge(v));
    return std::none_of(around.begin(), around.end(), [&](Face f) { return claimed_[f.idx()] == round_; });
  }

  // Whether all was free, and now is not.
  bool claim(const SurfaceStep& step) {
    vertices_.clear();
    for (const Face f : step.gone) {
      for (const Vertex v : mesh_.vertices_around_face(mesh_.halfedge(f))) vertices_.push_back(v);
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    if (!std::all_of(vertices_.begin(), vertices_.end(), [&](Vertex v) { return is_free(v); })) return false;
    for (const Vertex v : vertices_) {
      for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) claimed_[f.idx()] = round_;
    }
    return true;
  }

 private:
  const SurfaceMesh& mesh_;
  std::size_t round_ = 0;
  std::vector<std::size_t> claimed_;  // by face: in which round last
  std::vector<Vertex> vertices_;
};

// Steps are measured and proven on all threads, then those that do not touch are taken one after the other, in an order
// that does not depend on the threads.
class Coarsener {
 public:
  Coarsener(BoundSurface& surface, const CoarseningGoal& goal, const LongestAt& longest, const Progress& progress)
      : surface_(surface),
        mesh_(surface.mesh),
        state_(surface),
        proof_(goal.proven.is_set() ? std::make_optional<KeptProof>(state_, goal.proven) : std::nullopt),
        steps_(state_, goal.proven, longest, proof_ ? kSkewest : kSkewestOfFew, [this](Face f) { return is_fixed(f); }),
        least_vertices_(goal.least_vertices),
        progress_(progress),
        claims_(mesh_) {
    for (const Vertex v : mesh_.vertices()) {
      if (surface_[v].role == BoundSurface::Role::lid) ++lids_;
    }
    make_room();
  }

  void run() {
    for (int round = 0; round < rounds_to_collapse(); ++round, ++rounds_) {
      if (is_few(collapse_all())) break;
      relax();
    }
    rounds_ = rounds_to_collapse();
    // With a limit, as few vertices as it allows are wanted, not a number of them.
    for (int round = 0; round < rounds_to_exchange(); ++round, ++rounds_) {
      relax();
      if (exchange() == 0) break;
    }
    rounds_ = rounds_to_collapse() + rounds_to_exchange();
    for (int round = 0; round < rounds_to_relax(); ++round, ++rounds_) {
      if (is_few(relax())) break;
    }
  }

 private:
  // What is known of a step at an edge or a vertex, from the last look at it.
  struct Known {
    double cost = kNever;
    BoundaryPoint target = {};
    std::size_t when = 0;
  };
  struct Candidate {
    double cost;
    Index item;

    auto operator<=>(const Candidate&) const = default;
  };

  // Whether no step may replace the face.
  bool is_fixed(Face f) const {
    if (proof_) return proof_->is_fixed(f);
    const FaceCorners corners = state_.corners(f);
    return std::any_of(corners.begin(), corners.end(), [&](Vertex v) { return surface_.held(v); });
  }

  std::size_t vertices() const { return mesh_.number_of_vertices() - lids_; }

  bool is_few(std::size_t steps) const {
    const double few = proof_ ? kFewStepsWithLimit : kFewSteps;
    return static_cast<double>(steps) < few * static_cast<double>(mesh_.number_of_vertices());
  }

  int rounds_to_collapse() const { return proof_ ? kRoundsWithLimit : kRounds; }
  int rounds_to_exchange() const { return proof_ ? 0 : kExchanges; }
  int rounds_to_relax() const { return proof_ ? kRelaxationsWithLimit : kRelaxations; }

  void poll() const {
    const int all = rounds_to_collapse() + rounds_to_exchange() + rounds_to_relax();
    report_progress(progress_, "coarsen", static_cast<double>(rounds_) / all);
  }

  void make_room() {
    changed_.resize(mesh_.num_vertices(), now_);
    collapses_.resize(mesh_.num_edges());
    flips_.resize(mesh_.num_edges());
    moves_.resize(mesh_.num_vertices());
  }

  // Whether faces there have changed since.
  bool has_changed(Vertex v, std::size_t since) const { return changed_[v.idx()] > since; }
  bool has_changed(Edge e, std::size_t since) const {
    return has_changed(mesh_.vertex(e, 0), since) || has_changed(mesh_.vertex(e, 1), since);
  }

  bool is_free(Vertex v) const { return claims_.is_free(v); }
  bool is_free(Edge e) const { return claims_.is_free(mesh_.vertex(e, 0)) && claims_.is_free(mesh_.vertex(e, 1)); }

  // Measures steps again.
  template <class Item, class Look>
  void measure(const std::vector<Item>& items, std::vector<Known>& known, const Look& look) const {
    tbb::parallel_for(std::size_t{0}, items.size(), [&](std::size_t i) {
      const std::optional<CoarseningStep> step = look(items[i]);
      known[items[i].idx()] = step ? Known{step->cost, step->target, now_} : Known{kNever, {}, now_};
    });
  }

  // Proves steps that do not touch, and takes those that it can, at most `most`; `take` returns the step's vertex as it
  // is called then. The others are not tried again until something changes there. Returns how many were taken.
  template <class Item, class Take>
  std::size_t take_together(std::vector<std::pair<Item, CoarseningStep>> batch, std::vector<Known>& known,
                            std::size_t most, const Take& take) {
    poll();
    batch.resize(std::min(batch.size(), most));
    std::vector<std::optional<KeptProof::Outlook>> outlooks(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      outlooks[i] = proof_ ? proof_->after(batch[i].second) : KeptProof::Outlook{};
    });
    ++now_;
    std::vector<Vertex> places;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const auto& [item, step] = batch[i];
      known[item.idx()].cost = kNever;
      if (!outlooks[i] || !surface_.allows(step) || (proof_ && !proof_->holds(step, *outlooks[i]))) continue;
      const Vertex v = take(item, step);
      if (proof_) proof_->note(step, *outlooks[i], v);
      places.push_back(v);
      note_around(v);
    }
    steps_.note(places);
    return places.size();
  }

  // From the cheapest on, those of the candidates that do not touch.
  template <class Item, class Build>
  std::vector<std::pair<Item, CoarseningStep>> that_do_not_touch(std::vector<Candidate> candidates,
                                                                 const Build& build) {
    std::sort(candidates.begin(), candidates.end());
    claims_.clear();
    std::vector<std::pair<Item, CoarseningStep>> batch;
    for (const Candidate& c : candidates) {
      const Item item(c.item);
      if (!is_free(item)) continue;
      CoarseningStep step{build(item), c.cost};
      if (claims_.claim(step)) batch.emplace_back(item, std::move(step));
    }
    return batch;
  }

  // Measures again what collapses cost where faces have changed.
  void update_costs() {
    std::vector<Edge> edges;
    for (const Edge e : mesh_.edges()) {
      if (has_changed(e, collapses_[e.idx()].when)) edges.push_back(e);
    }
    measure(edges, collapses_, [&](Edge e) { return steps_.collapse(e); });
  }

  std::vector<Candidate> collapses_left() const {
    std::vector<Candidate> left;
    for (const Edge e : mesh_.edges()) {
      if (std::isfinite(collapses_[e.idx()].cost)) left.push_back({collapses_[e.idx()].cost, e.idx()});
    }
    return left;
  }

  // Leaves those that are taken next, and those that cost the same. None of them costs more than what is returned.
  double keep_cheapest(std::vector<Candidate>& left) const {
    const double share = proof_ ? kBatch : kBatchOfFew;
    const auto rank = std::min(
        left.size() - 1, std::max(kLeastBatch, static_cast<std::size_t>(share * static_cast<double>(left.size()))));
    std::nth_element(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(rank), left.end());
    const double most = left[rank].cost;
    std::erase_if(left, [most](const Candidate& c) { return c.cost > most; });
    return most;
  }

  // One pass over all edges. What has changed is measured again when it is its turn. Returns how many were collapsed.
  std::size_t collapse_all() {
    update_costs();
    std::size_t count = 0;
    while (vertices() > least_vertices_) {
      std::vector<Candidate> cheapest = collapses_left();
      if (cheapest.empty()) break;
      const double most = keep_cheapest(cheapest);
      std::vector<Edge> changed;
      for (const Candidate& c : cheapest) {
        if (has_changed(Edge(c.item), collapses_[c.item].when)) changed.emplace_back(c.item);
      }
      measure(changed, collapses_, [&](Edge e) { return steps_.collapse(e); });
      for (Candidate& c : cheapest) c.cost = collapses_[c.item].cost;
      std::erase_if(cheapest, [most](const Candidate& c) { return c.cost > most; });
      count += collapse(std::move(cheapest));
    }
    return count;
  }

  std::size_t collapse(std::vector<Candidate> candidates) {
    auto batch = that_do_not_touch<Edge>(std::move(candidates), [&](Edge e) {
      return surface_.collapsing(mesh_.vertex(e, 0), mesh_.vertex(e, 1), collapses_[e.idx()].target);
    });
    return take_together(std::move(batch), collapses_, vertices() - least_vertices_,
                         [&](Edge e, const CoarseningStep& step) {
                           const Vertex v = surface_.collapse_edge(e, step.target);
                           look_again_around(v, step.cost);
                           return v;
                         });
  }

  // Splits edges where that gains more than collapses cost elsewhere, and collapses as many. Returns how many.
  std::size_t exchange() {
    update_costs();
    const std::size_t count = split_where_it_pays();
    collapse_all();
    return count;
  }

  std::size_t split_where_it_pays() {
    const std::vector<Edge> edges(mesh_.edges().begin(), mesh_.edges().end());
    std::vector<double> gain(edges.size()), cost(edges.size());
    tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t i) {
      const std::optional<CoarseningStep> step = steps_.split(edges[i]);
      gain[i] = step ? -step->cost : 0;
      cost[i] = collapses_[edges[i].idx()].cost;
    });
    std::sort(cost.begin(), cost.end());
    std::vector<std::size_t> order(edges.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return gain[a] > gain[b]; });
    std::vector<char> near_split(mesh_.num_faces(), 0);
    std::vector<Vertex> places;
    poll();
    ++now_;
    for (const std::size_t i : order) {
      const std::size_t paid_with = kEdgesPerVertex * places.size();
      if (paid_with >= cost.size() || !(gain[i] >= kPays * cost[paid_with])) break;
      const Halfedge h = mesh_.halfedge(edges[i]), o = mesh_.opposite(h);
      if (near_split[mesh_.face(h).idx()] || near_split[mesh_.face(o).idx()]) continue;
      for (const Vertex v :
           {mesh_.source(h), mesh_.target(h), mesh_.target(mesh_.next(h)), mesh_.target(mesh_.next(o))}) {
        for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) near_split[f.idx()] = 1;
      }
      if (const std::optional<Vertex> v = split(edges[i])) places.push_back(*v);
    }
    steps_.note(places);
    return places.size();
  }

  // Not with a proof. Returns the vertex added; nothing if the edge cannot be split.
  std::optional<Vertex> split(Edge e) {
    const CoarseningStep step = *steps_.split(e);
    if (!surface_.allows(step)) return std::nullopt;
    const Vertex v = surface_.split_edge(e);
    surface_.place(v, step.target.position, step.target.sample);
    make_room();
    note_around(v);
    return v;
  }

  // Takes steps that leave less deviation and as many vertices, so that more can go. Returns how many.
  std::size_t relax() {
    const auto build_flip = [&](Edge e) { return surface_.flipping(mesh_.halfedge(e)); };
    const auto look_for_flip = [&](Edge e) { return steps_.flip(e); };
    std::size_t count =
        take_all<Edge>(mesh_.edges(), flips_, look_for_flip, build_flip, [&](Edge e, const CoarseningStep& step) {
          surface_.flip_edge(mesh_.halfedge(e));
          return step.vertex;
        });
    const auto build_move = [&](Vertex v) { return surface_.moving(v, moves_[v.idx()].target); };
    const auto look_for_move = [&](Vertex v) { return steps_.move(v); };
    count += take_all<Vertex>(mesh_.vertices(), moves_, look_for_move, build_move,
                              [&](Vertex v, const CoarseningStep& step) {
                                surface_.place(v, step.target.position, step.target.sample);
                                return v;
                              });
    return count;
  }

  // Each step at most once. Only what has changed since the last look is looked at.
  template <class Item, class Range, class Look, class Build, class Take>
  std::size_t take_all(const Range& all, std::vector<Known>& known, const Look& look, const Build& build,
                       const Take& take) {
    std::vector<Item> open(all.begin(), all.end());
    std::size_t count = 0;
    while (!open.empty()) {
      std::vector<Item> changed;
      for (const Item item : open) {
        if (has_changed(item, known[item.idx()].when)) changed.push_back(item);
      }
      measure(changed, known, look);
      std::erase_if(open, [&](Item item) { return !std::isfinite(known[item.idx()].cost); });
      std::vector<Candidate> candidates;
      for (const Item item : open) candidates.push_back({known[item.idx()].cost, item.idx()});
      auto batch = that_do_not_touch<Item>(std::move(candidates), build);
      count += take_together(std::move(batch), known, open.size(), take);
      std::erase_if(open, [&](Item item) { return !std::isfinite(known[item.idx()].cost); });
    }
    return count;
  }

  // Edges of the faces there that could not be collapsed may be now: they are looked at as if they cost that much.
  void look_again_around(Vertex v, double cost) {
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      for (const Edge e : {mesh_.edge(h), mesh_.edge(mesh_.prev(h))}) {
        if (!std::isfinite(collapses_[e.idx()].cost)) collapses_[e.idx()].cost = cost;
      }
    }
  }

  void note_around(Vertex v) {
    changed_[v.idx()] = now_;
    for (const Vertex w : mesh_.vertices_around_target(mesh_.halfedge(v))) changed_[w.idx()] = now_;
  }

  BoundSurface& surface_;
  SurfaceMesh& mesh_;
  SweepState state_;
  std::optional<KeptProof> proof_;
  CoarseningSteps steps_;
  std::size_t least_vertices_;
  std::size_t lids_ = 0;
  const Progress& progress_;
  int rounds_ = 0;
  Claims claims_;
  std::size_t now_ = 1;                   // counts batches
  std::vector<std::size_t> changed_;      // by vertex: when faces there changed last
  std::vector<Known> collapses_, flips_;  // by edge
  std::vector<Known> moves_;              // by vertex
};

// Whether the surface is a manifold, so that it can be worked on.
bool build(const FinishedSurface& from, BoundSurface& surface) {
  for (Index v = 0; v < from.mesh.vertices.size(); ++v) {
    const Vec3& p = from.mesh.vertices[v];
    FieldSample sample = surface.field.sample_fast(p, from.binding[v].segment);
    sample.cone = from.binding[v].segment;
    sample.t = from.binding[v].t;
    surface.place(surface.mesh.add_vertex(p), p, sample);
  }
  for (const auto& [a, b, c] : from.mesh.faces) {
    if (surface.mesh.add_face(Vertex(a), Vertex(b), Vertex(c)) == SurfaceMesh::null_face()) return false;
  }
  for (const Opening& opening : from.openings) {
    std::vector<Vertex> loop;
    for (const Index v : opening.ring) loop.emplace_back(v);
    surface.close_with_lid(loop, opening.center);
  }
  return true;
}

}  // namespace

RefusedSteps coarsen(FinishedSurface& surface, const VesselField& field, const CoarseningGoal& goal,
                     const LongestAt& longest, const Progress& progress) {
  BoundSurface work(field);
  if (!build(surface, work)) return {};
  work.guard_crossings(BoundSurface::Axes::all);
  Coarsener(work, goal, longest, progress).run();
  GenerateResult result;
  const std::vector<Index> number = work.export_to(result);
  surface.mesh = std::move(result.mesh);
  surface.binding = std::move(result.binding);
  surface.radius = std::move(result.radius);
  for (Opening& opening : surface.openings) {
    for (Index& v : opening.ring) v = number[v];
  }
  return work.refused();
}

}  // namespace vmesh

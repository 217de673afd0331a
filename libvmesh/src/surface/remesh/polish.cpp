#include "surface/remesh/polish.h"

#include "vmesh/core/ascending.h"

#include "surface/remesh/relocation.h"

namespace vmesh {
namespace {

constexpr int kRounds = 2, kSweeps = 20;  // kRounds: safe 1 to 3; kSweeps: safe 14 to 28
// Of crowded surfaces. Measured on short stars of 1,000 branches: with kSweeps, polishing takes half as long again, and
// the mean skewness is the same (.095).
constexpr int kSweepsInPits = 6;
constexpr int kPower = 32;       // of the energies in a sum that approximates their maximum; safe 22 to 45
constexpr int kRelaxSweeps = 6;  // that improve all faces without making the worst worse; safe 4 to 8
// Move, in target lengths, from which on the neighbours are revisited; safe 0.0035 to 0.007.
constexpr double kNoticeableMove = 0.005;
constexpr int kPatience = 10;  // patience limit: faces in a row without a helpful flip; safe 7 to 14
// Ratios of the worst energy nearby to that before: a flip is pursued if it is below kNearlyAsGood at once, and kept if
// it is below kPaysOff in the end. kNearlyAsGood: safe 1.4 to 2.8; kPaysOff: safe 0.7 to 1.4.
constexpr double kNearlyAsGood = 2, kPaysOff = 0.997;
constexpr int kFlipSweeps = 8;  // safe 6 to 11

class Polisher {
 public:
  Polisher(SweepState& state, Remesher& remesher, double good_energy)
      : state_(state), remesher_(remesher), surface_(state.surface), mesh_(state.mesh), good_energy_(good_energy) {}

  void polish() {
    for (int round = 0; round < kRounds; ++round) {
      improve_shape();
      flip_with_foresight();
    }
    relax();
  }

 private:
  struct Place {
    Vertex vertex;
    Vec3 position;
    FieldSample sample;
  };

  // Every sweep visits what the previous one has stirred.
  void improve_shape() {
    state_.stir_all();
    std::vector<Face> bad = bad_faces({mesh_.faces().begin(), mesh_.faces().end()});
    const int sweeps = surface_.crowded ? kSweepsInPits : kSweeps;
    for (int sweep = 0; sweep < sweeps && state_.next_sweep() > 0; ++sweep) {
      const std::vector<Vertex> vertices = active(with_neighbours(corners_of(bad)));
      for (const Edge e : edges_of(vertices)) remesher_.flip_for_shape(e);
      relocate_vertices(state_, vertices, {.power = kPower, .noticeable = kNoticeableMove});
      moved_.insert(moved_.end(), vertices.begin(), vertices.end());
      for (const Face f : faces_of(vertices)) bad.push_back(f);
      sort_unique(bad);
      bad = bad_faces(std::move(bad));
    }
  }

  void relax() {
    sort_unique(moved_);
    state_.stir_all();
    for (int sweep = 0; sweep < kRelaxSweeps && state_.next_sweep() > 0; ++sweep)
      relocate_vertices(state_, active(moved_), {.highest = good_energy_, .noticeable = kNoticeableMove});
  }

  std::vector<Vertex> active(std::vector<Vertex> vertices) const {
    std::erase_if(vertices, [&](Vertex v) { return !state_.active(v); });
    return vertices;
  }

  // Tries flips that may make things worse at first, starting at the worst faces.
  void flip_with_foresight() {
    std::vector<std::pair<double, Face>> queue;
    for (const Face f : bad_faces({mesh_.faces().begin(), mesh_.faces().end()})) queue.emplace_back(-energy(f), f);
    std::sort(queue.begin(), queue.end());
    int failures = 0;
    for (const auto& [_, f] : queue) {
      if (energy(f) < good_energy_) continue;  // already mended by a flip nearby
      failures = mend(f) ? 0 : failures + 1;
      if (failures == kPatience) break;
    }
  }

  bool mend(Face f) {
    const std::array<Vertex, 3> corners = state_.corners(f);
    for (const Edge e : edges_of(with_neighbours({corners.begin(), corners.end()}))) {
      if (flip_pays_off(e)) return true;
    }
    return false;
  }

  bool flip_pays_off(Edge e) {
    const std::vector<Vertex> nearby = surroundings(e);
    const double before = worst_energy(nearby);
    if (!remesher_.flip_with_foresight(e)) return false;
    if (worst_energy(nearby) < kNearlyAsGood * before) {
      const std::vector<Place> places = places_of(nearby);
      for (int sweep = 0; sweep < kFlipSweeps; ++sweep) relocate_vertices(state_, nearby, {.power = kPower});
      if (worst_energy(nearby) < kPaysOff * before) {
        moved_.insert(moved_.end(), nearby.begin(), nearby.end());
        return true;
      }
      for (const Place& place : places) surface_.place(place.vertex, place.position, place.sample);
    }
    remesher_.flip_back(e);
    return false;
  }

  std::vector<Place> places_of(const std::vector<Vertex>& vertices) const {
    std::vector<Place> places;
    for (const Vertex v : vertices)
      places.push_back(
          {v, state_.point(v), {surface_[v].distance, surface_[v].gradient, surface_[v].cone, surface_[v].t}});
    return places;
  }

  double energy(Face f) const {
    const auto [a, b, c] = state_.corners(f);
    return state_.energy(a, b, c);
  }

  double worst_energy(const std::vector<Vertex>& vertices) const {
    double worst = 0;
    for (const Vertex v : vertices) {
      for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) worst = std::max(worst, energy(f));
    }
    return worst;
  }

  // Faces worth polishing. Not folded ones: shape alone does not tell what would improve them.
  std::vector<Face> bad_faces(std::vector<Face> faces) const {
    std::erase_if(faces, [&](Face f) { return energy(f) < good_energy_ || folded(f); });
    return faces;
  }

  bool folded(Face f) const {
    const auto [a, b, c] = state_.corners(f);
    return state_.agreement(a, b, c) < SweepState::kMinAgreement;
  }

  // The ends of the edge, the apexes beside it, and all their neighbours.
  std::vector<Vertex> surroundings(Edge e) const {
    const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
    return with_neighbours(
        {mesh_.source(h), mesh_.target(h), mesh_.target(mesh_.next(h)), mesh_.target(mesh_.next(o))});
  }

  std::vector<Vertex> corners_of(const std::vector<Face>& faces) const {
    std::vector<Vertex> vertices;
    for (const Face f : faces) {
      for (const Vertex v : state_.corners(f)) vertices.push_back(v);
    }
    return vertices;
  }

  std::vector<Vertex> with_neighbours(std::vector<Vertex> vertices) const {
    sort_unique(vertices);
    const std::size_t count = vertices.size();
    for (std::size_t i = 0; i < count; ++i) {
      for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(vertices[i])))
        vertices.push_back(mesh_.source(h));
    }
    sort_unique(vertices);
    return vertices;
  }

  std::vector<Edge> edges_of(const std::vector<Vertex>& vertices) const {
    std::vector<Edge> edges;
    for (const Vertex v : vertices) {
      for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) edges.push_back(mesh_.edge(h));
    }
    sort_unique(edges);
    return edges;
  }

  std::vector<Face> faces_of(const std::vector<Vertex>& vertices) const {
    std::vector<Face> faces;
    for (const Vertex v : vertices) {
      for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) faces.push_back(f);
    }
    sort_unique(faces);
    return faces;
  }

  SweepState& state_;
  Remesher& remesher_;
  BoundSurface& surface_;
  SurfaceMesh& mesh_;
  const double good_energy_;
  std::vector<Vertex> moved_;
};

}  // namespace

void polish(SweepState& state, Remesher& remesher, double good_energy) {
  Polisher(state, remesher, good_energy).polish();
}

}  // namespace vmesh

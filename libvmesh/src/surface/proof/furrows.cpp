#include "surface/proof/furrows.h"

#include <algorithm>
#include <array>
#include <utility>

#include "vmesh/core/ascending.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/soundness.h"

namespace vmesh {
namespace {

// Cosine between walls below which an edge from one to the other is across a gap.
constexpr double kAcross = 0.3;
// How deep a gap may be below an edge, in edges, to be gone down at once: three are a gap of 19 degrees.
constexpr double kShallow = 0.3, kDeepest = 6;
constexpr double kApart = 0.5;  // of vertices on the crease, in depths
constexpr int kTries = 4;       // of a strip; each leaves out what was in the way

// An edge across a gap, and the point of the crease below it.
struct Crossing {
  MeshEdge edge;  // with its smaller end first
  double cosine;  // between the walls
  Crease crease;
  BoundaryPoint below;
  double depth;          // mm
  bool counts = true;    // until it is in the way, or replaced
  Index vertex = kNone;  // what its strip is to have there
};

class Plough {
 public:
  Plough(FinishedMesh& mesh, GuardedEdit<FinishedVertex>& edit, const VesselField& field,
         const std::function<double(Index)>& limit_at, const std::vector<char>& held)
      : mesh_(mesh), edit_(edit), field_(field), limit_at_(limit_at), held_(held) {}

  std::vector<std::pair<Index, Crease>> run(const std::vector<Index>& faces) {
    find_crossings(faces);
    for (int round = 0; round < kTries; ++round) {
      leave_two_of_three();
      bool any_left_out = false;
      for (const std::vector<Index>& strip : strips()) any_left_out = !replace(strip) || any_left_out;
      if (!any_left_out) break;
    }
    return std::move(on_creases_);
  }

 private:
  using Patch = FinishedMesh::Patch;

  const Vec3& point(Index v) const { return mesh_.position(v); }
  static MeshEdge sorted(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

  std::vector<MeshEdge> edges_of(const std::vector<Index>& faces) const {
    std::vector<MeshEdge> edges;
    for (const Index f : faces) {
      if (!mesh_.has_face(f)) continue;
      const auto& [a, b, c] = mesh_.faces()[f];
      edges.insert(edges.end(), {sorted(a, b), sorted(b, c), sorted(c, a)});
    }
    sort_unique(edges);
    return edges;
  }

  void find_crossings(const std::vector<Index>& faces) {
    std::vector<FieldSample> samples(mesh_.vertices().size());  // of vertices that are asked for
    const auto sample_at = [&](Index v) -> const FieldSample& {
      if (samples[v].cone == kNone) samples[v] = field_.sample(point(v), mesh_.vertex(v).binding.segment);
      return samples[v];
    };
    for (const MeshEdge& e : edges_of(faces)) {
      const FieldSample &a = sample_at(e.a), &b = sample_at(e.b);
      const double cosine = a.gradient.dot(b.gradient);
      if (cosine > kAcross || held_[e.a] || held_[e.b] || !mesh_.is_inner(e)) continue;
      const Vec3 middle = 0.5 * (point(e.a) + point(e.b));
      const double length = (point(e.a) - point(e.b)).norm();
      for (const Crease& crease : creases_between(field_, {point(e.a), {a.cone}}, {point(e.b), {b.cone}})) {
        const auto below = onto_crease(field_, crease, middle, std::min(limit_at_(e.a), limit_at_(e.b)));
        if (!below) continue;
        const double depth = (below->position - middle).norm();
        if (depth < kShallow * length || depth > kDeepest * length) continue;
        if ((below->position - middle).dot(a.gradient + b.gradient) > 0) continue;
        crossings_.push_back({e, cosine, crease, *below, depth});
        break;
      }
    }
  }

  Crossing* crossing_at(Index a, Index b) {
    const MeshEdge e = sorted(a, b);
    const auto it = std::lower_bound(crossings_.begin(), crossings_.end(), e,
                                     [](const Crossing& c, const MeshEdge& edge) { return c.edge < edge; });
    return it != crossings_.end() && it->edge == e && it->counts ? &*it : nullptr;
  }

  std::vector<Crossing*> crossings_of(Index f) {
    std::vector<Crossing*> crossings;
    const Triangle& face = mesh_.faces()[f];
    for (std::size_t k = 0; k < 3; ++k) {
      if (Crossing* crossing = crossing_at(face[k], face[(k + 1) % 3])) crossings.push_back(crossing);
    }
    return crossings;
  }

  std::vector<Index> faces_across() const {
    std::vector<Index> faces;
    for (const Crossing& crossing : crossings_) {
      if (!crossing.counts) continue;
      const auto [a, b] = crossing.edge;
      faces.push_back(mesh_.face_of(a, b));
      faces.push_back(mesh_.face_of(b, a));
    }
    sort_unique(faces);
    return faces;
  }

  // Where three vessels meet, the edge between the walls that face each other least.
  void leave_two_of_three() {
    for (const Index f : faces_across()) {
      const std::vector<Crossing*> crossings = crossings_of(f);
      if (crossings.size() < 3) continue;
      Crossing* least = crossings[0];
      for (Crossing* crossing : crossings) {
        if (crossing->cosine > least->cosine) least = crossing;
      }
      least->counts = false;
    }
  }

  // Faces joined by edges across the gap, in the order in which they lie; each has one or two of these.
  std::vector<std::vector<Index>> strips() {
    std::vector<std::vector<Index>> all;
    const std::vector<Index> faces = faces_across();
    std::vector<char> seen(mesh_.faces().size(), 0);
    const auto follow = [&](Index f) {
      std::vector<Index> strip;
      while (f != kNone && !std::exchange(seen[f], char{1})) {
        strip.push_back(f);
        Index next = kNone;
        for (const Crossing* crossing : crossings_of(f)) {
          const auto [a, b] = crossing->edge;
          for (const Index g : {mesh_.face_of(a, b), mesh_.face_of(b, a)}) {
            if (g != f && !seen[g]) next = g;
          }
        }
        f = next;
      }
      return strip;
    };
    for (const std::size_t crossings : {1, 2}) {  // from their ends; then those that have none
      for (const Index f : faces) {
        if (!seen[f] && crossings_of(f).size() == crossings) all.push_back(follow(f));
      }
    }
    return all;
  }

  // Puts vertices on the crease below the edges across the gap; neighbours share one where they would be close.
  struct Furrow {
    Patch patch;
    std::vector<Crease> creases;  // of the vertices added
  };
  Furrow furrow_below(const std::vector<Index>& strip) {
    for (const Index f : strip) {
      for (Crossing* crossing : crossings_of(f)) crossing->vertex = kNone;
    }
    Furrow furrow;
    std::vector<FinishedVertex>& added = furrow.patch.added;
    for (const Index f : strip) {
      for (Crossing* crossing : crossings_of(f)) {
        if (crossing->vertex != kNone) continue;
        const Vec3& below = crossing->below.position;
        if (added.empty() || (added.back().position - below).norm() > kApart * crossing->depth) {
          added.push_back(finished_vertex(crossing->below, field_));
          furrow.creases.push_back(crossing->crease);
        }
        crossing->vertex = static_cast<Index>(mesh_.vertices().size() + added.size() - 1);
      }
    }
    return furrow;
  }

  double worst_of(const Patch& patch, const std::vector<Triangle>& faces) const {
    double worst = 0;
    for (const Triangle& f : faces) {
      const PlacedFace placed = mesh_.placed(f, patch);
      worst = std::max(worst, equiangle_skewness(placed.points[0], placed.points[1], placed.points[2]));
    }
    return worst;
  }

  // What becomes of a face of the strip.
  std::vector<Triangle> parts_of(Index f, const Furrow& furrow) {
    const auto below = [&](Index a, Index b) {
      const Crossing* crossing = crossing_at(a, b);
      return crossing ? crossing->vertex : kNone;
    };
    Triangle face = mesh_.faces()[f];
    // With one crossing it becomes the first edge, with two their common corner the first.
    while (below(face[0], face[1]) == kNone || (below(face[1], face[2]) != kNone))
      std::rotate(face.begin(), face.begin() + 1, face.end());
    const auto [x, y, z] = face;
    const Index m = below(x, y), n = below(z, x);
    if (n == kNone) return {{x, m, z}, {m, y, z}};
    if (m == n) return {{m, y, z}};
    const std::vector<Triangle> one = {{x, m, n}, {m, y, z}, {m, z, n}}, other = {{x, m, n}, {m, y, n}, {y, z, n}};
    return worst_of(furrow.patch, one) <= worst_of(furrow.patch, other) ? one : other;
  }

  bool is_good(const Triangle& face, const Patch& patch) const {
    const auto& [a, b, c] = mesh_.placed(face, patch).points;
    if (equiangle_skewness(a, b, c) > kWorstSkewness) return false;
    const Vec3 normal = (b - a).cross(c - a), center = (a + b + c) / 3;
    return normal.dot(field_.sample_global(center).gradient) > 0;
  }

  // Whether the faces around a vertex will be one fan.
  bool stays_manifold(Index v, const Patch& patch) const {
    std::vector<std::array<Index, 2>> sides;  // of faces, opposite the vertex
    const auto add = [&](const Triangle& face) {
      const auto [at, a, b] = FinishedMesh::turned_to(v, face);
      sides.push_back({a, b});
    };
    if (v < mesh_.vertices().size()) {
      for (const Index f : mesh_.faces_around(v)) {
        if (std::find(patch.gone.begin(), patch.gone.end(), f) == patch.gone.end()) add(mesh_.faces()[f]);
      }
    }
    for (const Triangle& f : patch.faces) {
      if (has_corner(f, v)) add(f);
    }
    Index at = sides[0][0];
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const auto next = std::find_if(sides.begin(), sides.end(), [&](const auto& side) { return side[0] == at; });
      if (next == sides.end() || (i > 0 && at == sides[0][0])) return false;
      at = (*next)[1];
    }
    return at == sides[0][0];
  }
  bool stays_manifold(const Patch& patch) const {
    return std::all_of(patch.faces.begin(), patch.faces.end(), [&](const Triangle& f) {
      return std::all_of(f.begin(), f.end(), [&](Index v) { return stays_manifold(v, patch); });
    });
  }

  // Returns whether the strip was replaced; else the edges that are in the way do not count any more.
  bool replace(const std::vector<Index>& strip) {
    Furrow furrow = furrow_below(strip);
    std::vector<Crossing*> all, in_the_way;
    for (const Index f : strip) {
      const std::vector<Crossing*> crossings = crossings_of(f);
      all.insert(all.end(), crossings.begin(), crossings.end());
      furrow.patch.gone.push_back(f);
      for (const Triangle& part : parts_of(f, furrow)) {
        furrow.patch.faces.push_back(part);
        if (!is_good(part, furrow.patch)) in_the_way.insert(in_the_way.end(), crossings.begin(), crossings.end());
      }
    }
    const auto first = static_cast<Index>(mesh_.vertices().size());
    const bool is_taken = in_the_way.empty() && stays_manifold(furrow.patch) && edit_.take(furrow.patch);
    if (is_taken) {
      for (Index i = 0; i < furrow.creases.size(); ++i) on_creases_.emplace_back(first + i, furrow.creases[i]);
    }
    for (Crossing* crossing : in_the_way.empty() ? all : in_the_way) crossing->counts = false;
    return is_taken;
  }

  FinishedMesh& mesh_;
  GuardedEdit<FinishedVertex>& edit_;
  const VesselField& field_;
  const std::function<double(Index)>& limit_at_;
  const std::vector<char>& held_;
  std::vector<Crossing> crossings_;  // ascending
  std::vector<std::pair<Index, Crease>> on_creases_;
};

}  // namespace

std::vector<std::pair<Index, Crease>> plough(FinishedMesh& mesh, GuardedEdit<FinishedVertex>& edit,
                                             const VesselField& field, const std::vector<Index>& faces,
                                             const std::function<double(Index)>& limit_at,
                                             const std::vector<char>& held) {
  return Plough(mesh, edit, field, limit_at, held).run(faces);
}

}  // namespace vmesh

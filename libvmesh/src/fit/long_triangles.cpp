#include "fit/long_triangles.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "fit/coarsening.h"
#include "fit/reshaping.h"

namespace vmesh::fitting {
namespace {

// Measured on portal veins 002 and 008 and SU201, see bench/README.md. 0.86: mean distances up to 2 % less, faces
// nearer to what counts as a defect (0.9).
constexpr double kMaxSkewness = 0.8;
constexpr LeastSquaresWeights kWeights = {.tangential = 0.01};  // 0.005 and 0.02: within 2 %
constexpr double kExchanged = 0.1;                              // of the vertices, in a round; 0.05: 1 to 3 % farther
constexpr int kRefits = 3, kExchanges = 3, kLongDivision = 3;

/// An edge whose middle is far from the reference.
struct FarEdge {
  double gain;  // squared distance times area, mm^4
  MeshEdge edge;
  Vec3 step;  // of the middle to the reference, mm

  bool operator<(const FarEdge& other) const { return std::tie(other.gain, edge) < std::tie(gain, other.edge); }
};

// By what splitting them gains.
std::vector<FarEdge> far_edges(const FitMesh& surface, const Matches& matches) {
  std::vector<FarEdge> edges;
  for (Index f = 0; f < surface.faces().size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Match& middle = matches.from_edges[kPerEdge * (3 * f + i) + kPerEdge / 2];
      if (middle.face == kNone) continue;
      const Triangle& face = surface.faces()[f];
      const MeshEdge e{face[(i + 1) % 3], face[(i + 2) % 3]};
      if (!surface.is_inner(e)) continue;
      const double area = surface.area_normal(f).norm() + surface.area_normal(surface.face_of(e.b, e.a)).norm();
      edges.push_back({middle.distance * middle.distance * area / 2, e, -middle.distance * middle.direction});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

// Whether no face becomes skewer than allowed, or than those that are replaced.
bool keeps_shapes(const FitMesh& surface, const FitMesh::Step& step) {
  double worst = kMaxSkewness;
  for (const Index f : step.gone) worst = std::max(worst, skewness_of(surface, f));
  return std::none_of(step.faces.begin(), step.faces.end(),
                      [&](const Triangle& f) { return skewness_after(surface, f, step) > worst; });
}

}  // namespace

LongTriangles::LongTriangles(FitMesh& surface, std::vector<Opening>& openings, const FitSetting& setting,
                             const std::vector<ReferenceSample>& samples, std::function<void()> round)
    : surface_(surface), openings_(openings), setting_(setting), samples_(samples), round_(std::move(round)) {
  setting_.guard.max_skewness = std::max(setting_.guard.max_skewness, kMaxSkewness);
  setting_.even = false;
}

void LongTriangles::make(std::size_t vertices, double elongation, bool deformable) {
  deformable_ = deformable;
  find_elongation(surface_, elongation);
  coarsen_to(vertices);
  for (int i = 0; i < kRefits; ++i) refit();
  for (int i = 0; i < kExchanges; ++i) exchange(vertices);
  refit();
}

void LongTriangles::refit() {
  step_nearer(surface_, next_matches(), setting_, {}, kWeights);
  change_safely(surface_, [&](FitMesh& surface, const std::vector<char>& frozen) {
    flip_closer(surface, frozen, false, setting_);
  });
}

void LongTriangles::exchange(std::size_t vertices) {
  const Matches matches = next_matches(true);
  change_safely(surface_, [&](FitMesh&, const std::vector<char>& frozen) {
    split_far_edges(matches, frozen, static_cast<std::size_t>(kExchanged * static_cast<double>(vertices)));
  });
  find_cones(surface_, setting_.field);
  step_nearer(surface_, next_matches(), setting_, {}, kWeights);
  coarsen_to(vertices);
  refit();
}

void LongTriangles::coarsen_to(std::size_t vertices) {
  coarsen(surface_, vertices, kMaxSkewness, deformable_ ? &setting_.field.relations() : nullptr);
  pack(surface_, openings_);
  find_cones(surface_, setting_.field);
}

// No two of them in the same surroundings.
void LongTriangles::split_far_edges(const Matches& matches, const std::vector<char>& frozen, std::size_t count) {
  std::vector<char> done = frozen;
  done.resize(surface_.vertices().size(), 0);
  for (const FarEdge& far : far_edges(surface_, matches)) {
    if (count == 0) return;
    const auto [a, b] = far.edge;
    const auto [c, d] = surface_.opposite(far.edge);
    if (done[a] || done[b] || done[c] || done[d]) continue;
    const Vec3 p = 0.5 * (surface_.position(a) + surface_.position(b)) + far.step;
    const FitMesh::Step step =
        surface_.splitting(far.edge, FitVertex::between(surface_.vertex(a), surface_.vertex(b), p));
    if (!keeps_shapes(surface_, step)) continue;
    surface_.take(step);
    for (const Index v : {a, b, c, d}) done[v] = 1;
    --count;
  }
}

Matches LongTriangles::next_matches(bool edges) {
  round_();
  Matches matches = find_matches(surface_, setting_.reference, samples_, setting_.field, {kLongDivision, edges});
  remember(surface_, matches);
  return matches;
}

}  // namespace vmesh::fitting

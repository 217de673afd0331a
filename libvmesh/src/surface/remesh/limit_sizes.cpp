#include "surface/remesh/limit_sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace vmesh {
namespace {

// How much of a vessel may be cut off, in limits: in balanced placement half of it is outside. The same as that of the
// edges around a vessel that edge_length_for() gives.
constexpr double kMostCutOff = 1.5;
// With .3, random trees with valleys that are very sharp were not proven.
constexpr double kLeastFineness = 0.7;
// Cosine between the boundary's normals at two corners below which there is a crease between them; around a vessel it
// is .94 with a limit of 1 %, .75 with 10 %.
constexpr double kCrease = 0.7;

/// How much is cut off at the middle of edges and faces, by the square of their size, 1/mm: of edges around a vessel
/// the eighth of its curvature, of faces on a sphere the sixth.
class CutOff {
 public:
  explicit CutOff(const SweepState& state) : state_(state), at_(state.mesh.num_vertices()) {
    for (const Edge e : state.mesh.edges())
      add(std::array{state.mesh.vertex(e, 0), state.mesh.vertex(e, 1)}, state.length(e) * state.length(e));
    for (const Face f : state.mesh.faces()) {
      if (!state.surface.is_lid(f)) add(state.corners(f), state.mean_square_edge(f));
    }
  }

  double at(Vertex v) const { return at_[v.idx()]; }

 private:
  void add(std::span<const Vertex> corners, double square_size) {
    if (cross_crease(corners)) return;
    const double cut_off = std::abs(state_.off_at_middle(corners)) / square_size;
    for (const Vertex v : corners) at_[v.idx()] = std::max(at_[v.idx()], cut_off);
  }

  // Shorter edges across a crease are no better: it is to have vertices on it.
  bool cross_crease(std::span<const Vertex> corners) const {
    if (!has_creases_) return false;
    const Vec3& normal = state_.surface[corners[0]].gradient;
    return std::any_of(corners.begin() + 1, corners.end(),
                       [&](Vertex v) { return state_.surface[v].gradient.dot(normal) < kCrease; });
  }

  const SweepState& state_;
  const bool has_creases_ = state_.field.relations().blend() == 0;
  std::vector<double> at_;  // by vertex, the most around it
};

}  // namespace

void make_finer_for(SweepState& state, double edge_per_radius, const ErrorLimit& limit) {
  const CutOff cut_off(state);
  for (const Vertex v : state.mesh.vertices()) {
    const double radius = state.surface.radius(v);
    const double longest = std::sqrt(kMostCutOff * limit.at(radius) / cut_off.at(v));
    double& fineness = state.surface[v].fineness;
    fineness = std::min(fineness, std::max(kLeastFineness, longest / (edge_per_radius * radius)));
  }
}

}  // namespace vmesh

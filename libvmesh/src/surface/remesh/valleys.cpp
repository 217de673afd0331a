#include "surface/remesh/valleys.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace vmesh {
namespace {

// How much of a valley edges may leave open, relative to what they cut off around a vessel; and the least factor on
// edges for that.
constexpr double kOpenInValleys = 1.5, kLeastInValleys = 0.3;

class Valleys {
 public:
  explicit Valleys(const SweepState& state) : state_(state), curvature_(state.mesh.num_vertices()) {
    for (const Edge e : state.mesh.edges()) {
      const Vertex a = state.mesh.vertex(e, 0), b = state.mesh.vertex(e, 1);
      add(std::array{a, b}, state.surface.valley_curvature(a, b));
    }
    for (const Face f : state.mesh.faces()) {
      if (!state.surface.is_lid(f) && is_in_valley(f)) add(state.corners(f), curvature(f));
    }
  }

  /// Towards the outside, 1/mm; 0 where there is no valley.
  double curvature(Vertex v) const { return curvature_[v.idx()]; }

 private:
  void add(std::span<const Vertex> vertices, double curvature) {
    for (const Vertex v : vertices) curvature_[v.idx()] = std::max(curvature_[v.idx()], curvature);
  }

  bool is_in_valley(Face f) const {
    const auto corners = state_.corners(f);
    return std::all_of(corners.begin(), corners.end(), [&](Vertex v) { return curvature(v) > 0; });
  }

  // An edge of length h across a valley of curvature k leaves k h^2 / 8 of it open, a face k h^2 / 12 at its middle.
  // There creases show that the normals at its corners do not tell of, as where three vessels meet.
  double curvature(Face f) const { return 12 * state_.off_at_middle(state_.corners(f)) / state_.mean_square_edge(f); }

  const SweepState& state_;
  std::vector<double> curvature_;
};

}  // namespace

void make_valleys_finer(SweepState& state) {
  const Valleys valleys(state);
  for (const Vertex v : state.mesh.vertices()) {
    const double sharpness = valleys.curvature(v) * state.surface.radius(v);
    if (sharpness <= kOpenInValleys) continue;
    double& fineness = state.surface[v].fineness;
    fineness = std::min(fineness, std::max(kLeastInValleys, std::sqrt(kOpenInValleys / sharpness)));
  }
}

}  // namespace vmesh

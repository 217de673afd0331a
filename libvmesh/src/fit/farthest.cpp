#include "fit/farthest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fit/fit_patch.h"
#include "fit/least_squares.h"
#include "fit/reshaping.h"
#include "fit/resizing.h"

namespace vmesh::fitting {
namespace {

constexpr int kFineDivision = 3, kRelaxations = 2;
constexpr std::size_t kEdgePoints = 3 * kPerEdge;  // of a face
// Multiple of the RMS distance from which on a place, such as a ridge crossed by a triangle, gets a vertex of its own.
// Measured on the aorta and SU201, sixteen starts (growth with `simplification` 0 to .8, vertices moved by 1e-6 radii):
// Hausdorff distance at most .97 and .29 mm with 3 to 4.5, 1.00 and .29 with 5; safe 3 to 4.5.
constexpr double kOfRms = 4;
// Edge lengths (largest mean at a corner): farther points are not for the surface to follow. More than the limit for
// refinement (kNotOfSize), as only what helps is kept. Measured on SU201, sixteen starts: at 0.6 and 0.8 the Hausdorff
// distance is at most .28 mm, at 0.4 once .37.
constexpr double kNotOfReach = 0.6;
constexpr std::size_t kMostPlaces = 12;
constexpr double kRefitReach = 2.5;  // edges, around a new vertex. Measured: 1.5 to 3.5 give the same
constexpr double kAtVertex = 1e-9;   // other weights below this: the point is a vertex
constexpr std::array<double, 3> kShares = {0.75, 0.5, 0.25};  // of its distance, by which a vertex is moved nearer
constexpr int kRounds = 3;                                    // of the refit. Measured: 2 to 4 give the same
// Least cosine between the normals of two faces of a ridge, unless it was less. In valleys, where vessels part, faces
// may lie on each other. Measured on hepatic veins 002 at .8 mm: 2,118 vertices, 3,240 and fins without the limit.
constexpr double kSharpest = -0.2;
// LeastSquaresWeights::emphasis of the refit where no vertex helps. Measured on the aorta: with 6 as near, with more
// skew triangles.
constexpr double kEmphasis = 3;

Vec3 point_of(const FitMesh& surface, const Match& match) {
  const auto [a, b, c] = surface.corners(match.face);
  return match.weights[0] * a + match.weights[1] * b + match.weights[2] * c;
}

// The matches of a patch of the surface, and their positions among all.
struct PatchMatches {
  Matches matches;
  std::vector<Index> samples;  // of the reference, by number among all
};

class FarPlaces {
 public:
  FarPlaces(FitMesh& surface, const std::vector<ReferenceSample>& samples, const FitSetting& setting)
      : surface_(surface), samples_(samples), setting_(setting) {
    matches_ = find_matches(surface, setting.reference, samples, setting.field, {kFineDivision, true});
  }

  void improve(std::size_t most_vertices) { bring_below(kOfRms * rms_distance(matches_), most_vertices, kMostPlaces); }

  void bring_below(double near, std::size_t most_vertices, std::size_t most_places) {
    std::vector<Place> left_alone;
    for (std::size_t i = 0; i < most_places; ++i) {
      const Match worst = farthest_match(surface_, matches_, left_alone);
      if (worst.face == kNone || std::abs(worst.distance) <= near) return;
      const Place place = place_of(surface_, worst);
      if (!bring_nearer(worst, surface_.vertices().size() < most_vertices)) left_alone.push_back(place);
    }
  }

 private:
  // Returns whether that brought its surroundings nearer.
  bool bring_nearer(const Match& worst, bool may_add) {
    double edge = 0;
    for (const Index v : surface_.faces()[worst.face]) edge = std::max(edge, surface_.mean_edge(v));
    if (std::abs(worst.distance) > kNotOfReach * edge) return false;
    const FitPatch patch = patch_around(surface_, worst.face, kRefitReach * edge);
    const PatchMatches before = matches_of(patch);
    Match there = worst;
    there.face =
        static_cast<Index>(std::lower_bound(patch.faces.begin(), patch.faces.end(), worst.face) - patch.faces.begin());
    double least = farthest(patch, before.matches);
    const double limit = std::max(setting_.guard.max_skewness, worst_skewness(patch));
    const double sharpest = std::min(kSharpest, sharpest_ridge(patch));
    std::optional<std::pair<FitPatch, PatchMatches>> best;
    const auto try_change = [&](const auto& change) {
      FitPatch changed = patch;
      PatchMatches after{{}, before.samples};
      change(changed, after);
      renew(changed, after, true);
      const double left = farthest(changed, after.matches);
      if (left >= least || worst_skewness(changed) > limit || sharpest_ridge(changed) < sharpest) return;
      least = left;
      best.emplace(std::move(changed), std::move(after));
    };
    Match cut = there;  // where to add a vertex
    if (is_tip(worst)) {
      for (const double share : kShares)
        try_change(
            [&](FitPatch& changed, PatchMatches&) { move_corner(changed, there, nearest_corner(there), share); });
      cut = farthest_beside(patch, before.matches, tip_of(patch, there));
    }
    if (!best && may_add && cut.face != kNone) {
      for (int side = 0; side < 3; ++side)
        try_change([&](FitPatch& changed, PatchMatches& matches) { put_vertex(changed, cut, side, matches); });
    }
    if (!best)
      try_change([&](FitPatch& changed, PatchMatches& matches) { refit(changed, matches, {.emphasis = kEmphasis}); });
    for (std::size_t corner = 0; corner < 3 && !best; ++corner)
      for (const double share : kShares)
        try_change([&](FitPatch& changed, PatchMatches&) { move_corner(changed, there, corner, share); });
    if (best) put_back(best->first, best->second);
    return best.has_value();
  }

  static bool is_tip(const Match& match) { return match.weights.maxCoeff() > 1 - kAtVertex; }

  static std::size_t nearest_corner(const Match& match) {
    Eigen::Index corner = 0;
    match.weights.maxCoeff(&corner);
    return static_cast<std::size_t>(corner);
  }

  static Index tip_of(const FitPatch& patch, const Match& match) {
    return patch.surface.faces()[match.face][nearest_corner(match)];
  }

  // The farthest match on the faces around a tip, which they cut off and it compensates for.
  static Match farthest_beside(const FitPatch& patch, const Matches& matches, Index tip) {
    Match farthest;
    for (const auto* list : {&matches.from_surface, &matches.from_reference, &matches.from_edges}) {
      for (const Match& match : *list) {
        if (match.face == kNone || is_tip(match) || std::abs(match.distance) <= std::abs(farthest.distance)) continue;
        const Triangle& face = patch.surface.faces()[match.face];
        if (std::find(face.begin(), face.end(), tip) != face.end()) farthest = match;
      }
    }
    return farthest;
  }

  void move_corner(FitPatch& patch, const Match& match, std::size_t corner, double share) const {
    std::vector<Vec3> steps(patch.surface.vertices().size(), Vec3::Zero());
    const Index v = patch.surface.faces()[match.face][corner];
    steps[v] = -share * match.distance * match.direction;
    keep_in_opening(patch.surface, v, setting_.opening_normals, steps[v]);
    take_steps(patch.surface, steps, setting_.guard);
  }

  void put_vertex(FitPatch& patch, const Match& match, int side, PatchMatches& matches) const {
    change(patch, [&](FitMesh& surface, const std::vector<char>& frozen) {
      split_at(surface, match, side);
      flip_closer(surface, frozen, false, setting_);
      flip_edges(surface, frozen, setting_.guard);
      for (int i = 0; i < kRelaxations; ++i) relax(surface, frozen, setting_.guard, 2);
      repair(surface, frozen, setting_.guard);
    });
    find_cones(patch.surface, setting_.field);
    refit(patch, matches, {});
  }

  void refit(FitPatch& patch, PatchMatches& matches, const LeastSquaresWeights& weights) const {
    for (int i = 0; i < kRounds; ++i) {
      renew(patch, matches, false);
      step_nearer(patch.surface, matches.matches, setting_, patch.frozen, weights);
      change(patch,
             [&](FitMesh& surface, const std::vector<char>& frozen) { repair(surface, frozen, setting_.guard); });
    }
  }

  // change_safely() on the free part of a patch.
  template <class Change>
  static void change(FitPatch& patch, Change&& change_free) {
    change_safely(patch.surface, [&](FitMesh& surface, const std::vector<char>& crossing) {
      std::vector<char> frozen = patch.frozen;
      for (std::size_t v = 0; v < frozen.size(); ++v) frozen[v] = frozen[v] || crossing[v];
      change_free(surface, frozen);
    });
  }

  void renew(const FitPatch& patch, PatchMatches& matches, bool edges) const {
    std::vector<ReferenceSample> samples;
    for (const Index i : matches.samples) samples.push_back(samples_[i]);
    MatchScope scope{kFineDivision, edges, {}};
    for (Index f = 0; f < patch.surface.faces().size(); ++f) scope.faces.push_back(patch.moves(f));
    matches.matches = find_matches(patch.surface, setting_.reference, samples, setting_.field, scope);
  }

  // The patch's matches, taken from those of the whole.
  PatchMatches matches_of(const FitPatch& patch) const {
    std::vector<Index> number(surface_.faces().size(), kNone);
    PatchMatches result;
    const auto per_face = static_cast<std::size_t>(matches_.per_face);
    for (Index f = 0; f < patch.faces.size(); ++f) {
      number[patch.faces[f]] = f;
      for (std::size_t i = 0; i < per_face; ++i) {
        result.matches.from_surface.push_back(matches_.from_surface[patch.faces[f] * per_face + i]);
        if (result.matches.from_surface.back().face != kNone) result.matches.from_surface.back().face = f;
      }
      for (std::size_t i = 0; i < kEdgePoints; ++i) {
        result.matches.from_edges.push_back(matches_.from_edges[kEdgePoints * patch.faces[f] + i]);
        if (result.matches.from_edges.back().face != kNone) result.matches.from_edges.back().face = f;
      }
    }
    for (Index i = 0; i < samples_.size(); ++i) {
      Match match = matches_.from_reference[i];
      if (match.face == kNone || number[match.face] == kNone || !patch.moves(number[match.face])) continue;
      match.face = number[match.face];
      result.matches.from_reference.push_back(match);
      result.samples.push_back(i);
    }
    return result;
  }

  void put_back(const FitPatch& patch, const PatchMatches& matches) {
    const std::vector<Index> faces = fitting::put_back(surface_, patch);
    const auto per_face = static_cast<std::size_t>(matches_.per_face);
    matches_.from_surface.resize(surface_.faces().size() * per_face);
    matches_.from_edges.resize(surface_.faces().size() * kEdgePoints);
    const auto place = [&](const Match& match, Match& all) {
      all = match;
      if (match.face != kNone) all.face = faces[match.face];
    };
    for (Index f = 0; f < faces.size(); ++f) {
      if (!patch.moves(f)) continue;
      for (std::size_t i = 0; i < per_face; ++i)
        place(matches.matches.from_surface[f * per_face + i], matches_.from_surface[faces[f] * per_face + i]);
      for (std::size_t i = 0; i < kEdgePoints; ++i)
        place(matches.matches.from_edges[kEdgePoints * f + i], matches_.from_edges[kEdgePoints * faces[f] + i]);
    }
    for (std::size_t i = 0; i < matches.samples.size(); ++i)
      place(matches.matches.from_reference[i], matches_.from_reference[matches.samples[i]]);
  }

  static double farthest(const FitPatch& patch, const Matches& matches) {
    double result = 0;
    for (const auto* list : {&matches.from_surface, &matches.from_reference, &matches.from_edges}) {
      for (const Match& match : *list) {
        if (match.face != kNone && patch.moves(match.face)) result = std::max(result, std::abs(match.distance));
      }
    }
    return result;
  }

  static double worst_skewness(const FitPatch& patch) {
    double worst = 0;
    for (Index f = 0; f < patch.surface.faces().size(); ++f) {
      if (patch.moves(f)) worst = std::max(worst, skewness_of(patch.surface, f));
    }
    return worst;
  }

  // Least cosine between the normals of two faces that meet in a ridge.
  static double sharpest_ridge(const FitPatch& patch) {
    const FitMesh& surface = patch.surface;
    double sharpest = 1;
    for (Index f = 0; f < surface.faces().size(); ++f) {
      if (!patch.moves(f)) continue;
      const Triangle& face = surface.faces()[f];
      const Vec3 normal = surface.unit_normal(f);
      for (std::size_t i = 0; i < 3; ++i) {
        const Index g = surface.face_of(face[(i + 1) % 3], face[i]);
        if (g == kNone || !is_ridge(surface, f, i, g)) continue;
        sharpest = std::min(sharpest, normal.dot(surface.unit_normal(g)));
      }
    }
    return sharpest;
  }

  // Whether face `g` at side `i` of face `f` goes inward from it.
  static bool is_ridge(const FitMesh& surface, Index f, std::size_t i, Index g) {
    const Triangle& face = surface.faces()[f];
    const Vec3 middle = (surface.position(face[i]) + surface.position(face[(i + 1) % 3])) / 2;
    const auto [a, b, c] = surface.corners(g);
    return surface.area_normal(f).dot((a + b + c) / 3 - middle) < 0;
  }

  FitMesh& surface_;
  const std::vector<ReferenceSample>& samples_;
  const FitSetting& setting_;
  Matches matches_;
};

}  // namespace

Place place_of(const FitMesh& surface, const Match& match) {
  return {point_of(surface, match), surface.mean_edge(surface.faces()[match.face][0])};
}

Match farthest_match(const FitMesh& surface, const Matches& matches, const std::vector<Place>& left_alone) {
  Match farthest;
  for (const auto* list : {&matches.from_surface, &matches.from_reference, &matches.from_edges}) {
    for (const Match& match : *list) {
      if (match.face == kNone || std::abs(match.distance) <= std::abs(farthest.distance)) continue;
      const Vec3 p = point_of(surface, match);
      if (std::none_of(left_alone.begin(), left_alone.end(), [&](const Place& place) { return place.holds(p); }))
        farthest = match;
    }
  }
  return farthest;
}

void split_at(FitMesh& surface, const Match& match, int side) {
  const Triangle face = surface.faces()[match.face];
  const Index a = face[(side + 1) % 3], b = face[(side + 2) % 3];
  if (!surface.is_inner(MeshEdge{a, b})) return;
  const Vec3 p = point_of(surface, match) - match.distance * match.direction;
  surface.take(surface.splitting({a, b}, FitVertex::between(surface.vertex(a), surface.vertex(b), p)));
}

void bring_farthest_nearer(FitMesh& surface, const std::vector<ReferenceSample>& samples, const FitSetting& setting,
                           std::size_t most_vertices) {
  FarPlaces(surface, samples, setting).improve(most_vertices);
}

void bring_below(FitMesh& surface, const std::vector<ReferenceSample>& samples, const FitSetting& setting,
                 std::size_t most_vertices, double limit) {
  FarPlaces(surface, samples, setting).bring_below(limit, most_vertices, surface.vertices().size());
}

}  // namespace vmesh::fitting

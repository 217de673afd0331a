#include "fit/correspondence.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "fit/closest_walk.h"

namespace vmesh::fitting {
namespace {

constexpr double kSameWay = 0.2;   // least cosine between normals
constexpr double kFarthest = 1.5;  // local radii
constexpr double kWalked = 0.25;   // local radii: a locally closest point that is farther may not be the closest
// Points farther apart than kNear local radii are counterparts only if neither has a much nearer one: nearer than
// kMutual times their distance.
constexpr double kNear = 0.25, kMutual = 0.2;
// Unless one that is farther than kApart local radii lies along the normal, up to a cosine of kAlong: as the saddle of
// the reference above that of two vessels that part too early, whose legs are near it.
constexpr double kApart = 0.6, kAlong = 0.8;
constexpr double kNoDistance = 1e-9;  // of a radius: below it the line between two points has no direction
constexpr double kOnEdge = 1e-9;      // a corner's weight on the edge opposite to it
constexpr std::size_t kGrain = 256;   // consecutive samples, each a hint for the next
constexpr Index kFaces = 32;          // the same for faces

// Centres of the triangles into which a face is divided, as weights of its corners.
std::vector<Vec3> pattern(int division) {
  std::vector<Vec3> points;
  const double n = 3.0 * division;
  for (int i = 0; i < division; ++i) {
    for (int j = 0; i + j < division; ++j) {
      const double u = (3 * i + 1) / n, v = (3 * j + 1) / n;
      points.emplace_back(1 - u - v, u, v);
      if (i + j + 1 < division) {
        const double s = (3 * i + 2) / n, t = (3 * j + 2) / n;
        points.emplace_back(1 - s - t, s, t);
      }
    }
  }
  return points;
}

Vec3 weights_at(const std::array<Vec3, 3>& corners, const Vec3& p) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double area2 = normal.squaredNorm();
  if (!(area2 > 0)) return Vec3::Constant(1.0 / 3);
  Vec3 weights;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = corners[(i + 1) % 3], &b = corners[(i + 2) % 3];
    weights[i] = std::max(0.0, (b - a).cross(p - a).dot(normal) / area2);
  }
  return weights / weights.sum();
}

class Matcher {
 public:
  Matcher(const FitMesh& surface, const FitReference& reference, const VesselField& field)
      : surface_(surface), reference_(reference), field_(field), index_(surface.tri_mesh()) {
    normals_.reserve(surface.faces().size());
    across_.reserve(surface.faces().size());
    for (Index f = 0; f < surface.faces().size(); ++f) {
      normals_.push_back(surface.unit_normal(f));
      const auto& [a, b, c] = surface.faces()[f];
      across_.push_back({surface.face_of(b, a), surface.face_of(c, b), surface.face_of(a, c)});
    }
  }

  Match from_surface(Index f, const Vec3& weights, double area, Index& near) const {
    return from_surface(f, weights, normals_[f], area, near);
  }

  // Match of a point on the side opposite to corner i, at the fraction `part` along it, with the mean normal of both
  // faces.
  Match from_edge(Index f, int i, double part) const {
    const Triangle& face = surface_.faces()[f];
    const Index a = face[(i + 1) % 3], b = face[(i + 2) % 3], g = surface_.face_of(b, a);
    if (g == kNone || g < f) return {};
    const Vec3 normal = (normals_[f] + normals_[g]).normalized();
    Vec3 weights = Vec3::Zero();
    weights[(i + 1) % 3] = 1 - part;
    weights[(i + 2) % 3] = part;
    Index near = surface_.vertex(part < 0.5 ? a : b).match;
    return from_surface(f, weights, normal, 0, near);
  }

  Match from_reference(const ReferenceSample& sample, Index& near) const {
    if (!reference_.is_near(sample.face)) return {};
    const Index cone = reference_.cone(sample.face);
    const double radius = widest_radius(field_, cone);
    const Vec3& normal = reference_.normal(sample.face);
    const auto found = on_surface(sample.position, normal, cone, kFarthest * radius, near);
    if (!found) return {};
    near = found->face;
    const Vec3 weights = weights_at(surface_.corners(found->face), found->point);
    if (is_on_border(found->face, weights)) return {};
    if (found->distance > kNear * radius) {
      const Index there = surface_.vertices()[surface_.faces()[found->face][0]].cone;
      const double limit = kMutual * found->distance;
      if (on_reference(found->point, normals_[found->face], there, limit, sample.face)) return {};
    }
    Match result = match(found->face, weights, found->point, sample.position, normal, radius, sample.area);
    result.other = sample.face;
    return result;
  }

 private:
  Match from_surface(Index f, const Vec3& weights, const Vec3& normal, double area, Index& near) const {
    const auto [a, b, c] = surface_.corners(f);
    const Vec3 p = weights[0] * a + weights[1] * b + weights[2] * c;
    int corner = 0;
    weights.maxCoeff(&corner);
    const Index cone = surface_.vertices()[surface_.faces()[f][corner]].cone;
    const double radius = widest_radius(field_, cone);
    const auto found = on_reference(p, normal, cone, kFarthest * radius, near);
    if (!found) return {};
    near = found->face;
    if (reference_.on_border(found->face, found->point)) return {};
    const bool is_along =
        found->distance > kApart * radius && std::abs((found->point - p).dot(normal)) > kAlong * found->distance;
    if (found->distance > kNear * radius &&
        !is_along) {  // not a counterpart if that point has a much nearer one itself
      const Index there = reference_.cone(found->face);
      const double limit = kMutual * found->distance;
      if (on_surface(found->point, reference_.normal(found->face), there, limit, f)) return {};
    }
    Match result = match(f, weights, p, found->point, reference_.normal(found->face), radius, area);
    result.other = found->face;
    return result;
  }

  std::optional<ClosestPoint> on_reference(const Vec3& p, const Vec3& normal, Index cone, double limit,
                                           Index near) const {
    const auto accepts = [&](Index g) {
      return reference_.normal(g).dot(normal) > kSameWay && reference_.is_near(g) &&
             same_vessel(field_, cone, reference_.cone(g));
    };
    return closest(reference_.index(), p, limit, accepts, near,
                   [&](Index g) -> const Triangle& { return reference_.across(g); });
  }

  std::optional<ClosestPoint> on_surface(const Vec3& p, const Vec3& normal, Index cone, double limit,
                                         Index near) const {
    const auto accepts = [&](Index f) {
      if (!(normal.dot(normals_[f]) > kSameWay)) return false;
      const Triangle& face = surface_.faces()[f];
      return std::any_of(face.begin(), face.end(),
                         [&](Index v) { return same_vessel(field_, cone, surface_.vertices()[v].cone); });
    };
    return closest(index_, p, limit, accepts, near, [&](Index f) -> const Triangle& { return across_[f]; });
  }

  // The closest of the accepted faces that is nearer than the limit. From a face nearby, what is locally closest and
  // near is taken for it.
  template <class Accepts, class Across>
  static std::optional<ClosestPoint> closest(const ClosestPointIndex& index, const Vec3& p, double limit,
                                             const Accepts& accepts, Index near, const Across& across) {
    if (near != kNone) {
      const auto found = walk_closer(index, p, near, across);
      if (found && found->distance <= kWalked / kFarthest * limit && accepts(found->face)) return found;
    }
    return index.closest_among(p, limit, accepts, near);
  }

  bool is_on_border(Index f, const Vec3& weights) const {
    for (int i = 0; i < 3; ++i) {
      const Index a = surface_.faces()[f][(i + 1) % 3], b = surface_.faces()[f][(i + 2) % 3];
      if (weights[i] < kOnEdge && on_border(surface_, a) && on_border(surface_, b)) return true;
    }
    return false;
  }

  static Match match(Index f, const Vec3& weights, const Vec3& on_surface, const Vec3& on_reference, const Vec3& normal,
                     double radius, double area) {
    const Vec3 away = on_surface - on_reference;
    const double distance = away.norm();
    if (distance < kNoDistance * radius) return {f, weights, normal, away.dot(normal), area, kNone};
    return {f, weights, away / distance, distance, area, kNone};
  }

  const FitMesh& surface_;
  const FitReference& reference_;
  const VesselField& field_;
  ClosestPointIndex index_;
  std::vector<Vec3> normals_;
  std::vector<Triangle> across_;
};

std::vector<Match> match_edges(const Matcher& matcher, Index face_count, const MatchScope& scope) {
  constexpr int kPoints = 3 * kPerEdge;
  std::vector<Match> matches(kPoints * static_cast<std::size_t>(face_count));
  tbb::parallel_for(Index{0}, face_count, [&](Index f) {
    if (!scope.has(f)) return;
    for (int i = 0; i < kPoints; ++i)
      matches[kPoints * f + static_cast<Index>(i)] =
          matcher.from_edge(f, i / kPerEdge, i % kPerEdge / (kPerEdge - 1.0));
  });
  return matches;
}

}  // namespace

Matches find_matches(const FitMesh& surface, const FitReference& reference, const std::vector<ReferenceSample>& samples,
                     const VesselField& field, const MatchScope& scope) {
  const Matcher matcher(surface, reference, field);
  const std::vector<Vec3> points = pattern(scope.division);
  Matches matches;
  matches.per_face = static_cast<int>(points.size());
  matches.from_surface.resize(surface.faces().size() * points.size());
  const auto face_count = static_cast<Index>(surface.faces().size());
  tbb::parallel_for(Index{0}, (face_count + kFaces - 1) / kFaces, [&](Index block) {
    for (Index f = block * kFaces; f < std::min(face_count, (block + 1) * kFaces); ++f) {
      if (!scope.has(f)) continue;
      const double area = surface.area_normal(f).norm() / (2 * static_cast<double>(points.size()));
      Index near = surface.vertex(surface.faces()[f][0]).match;
      for (std::size_t i = 0; i < points.size(); ++i)
        matches.from_surface[f * points.size() + i] = matcher.from_surface(f, points[i], area, near);
    }
  });
  std::vector<Index> matched(reference.mesh().faces.size(), kNone);  // a face of the surface for those of the reference
  for (const Match& match : matches.from_surface) {
    if (match.face != kNone) matched[match.other] = match.face;
  }
  matches.from_reference.resize(samples.size());
  tbb::parallel_for(std::size_t{0}, (samples.size() + kGrain - 1) / kGrain, [&](std::size_t block) {
    Index near = kNone;
    for (std::size_t i = block * kGrain; i < std::min(samples.size(), (block + 1) * kGrain); ++i) {
      if (const Index face = matched[samples[i].face]; face != kNone) near = face;
      matches.from_reference[i] = matcher.from_reference(samples[i], near);
    }
  });
  if (scope.edges) matches.from_edges = match_edges(matcher, face_count, scope);
  return matches;
}

void remember(FitMesh& surface, const Matches& matches) {
  for (const Match& match : matches.from_surface) {
    if (match.face == kNone) continue;
    Eigen::Index corner = 0;
    match.weights.maxCoeff(&corner);
    surface.edit(surface.faces()[match.face][static_cast<std::size_t>(corner)]).match = match.other;
  }
}

void follow(Matches& matches, const std::vector<FitVertex>& before, const FitMesh& surface) {
  for (auto* list : {&matches.from_surface, &matches.from_reference, &matches.from_edges}) {
    for (Match& match : *list) {
      if (match.face == kNone) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const Index v = surface.faces()[match.face][i];
        match.distance +=
            match.weights[static_cast<Eigen::Index>(i)] * match.direction.dot(surface.position(v) - before[v].position);
      }
    }
  }
}

double matched_distance(const Matches& matches, double share) {
  double result = 0;
  for (const auto* list : {&matches.from_surface, &matches.from_reference}) {
    std::vector<std::pair<double, double>> distances;  // with the areas they represent
    double total = 0;
    for (const Match& match : *list) {
      if (match.face == kNone) continue;
      distances.emplace_back(std::abs(match.distance), match.area);
      total += match.area;
    }
    std::sort(distances.begin(), distances.end());
    double sum = 0;
    for (const auto& [distance, area] : distances) {
      sum += area;
      if (sum < share * total) continue;
      result = std::max(result, distance);
      break;
    }
  }
  return result;
}

}  // namespace vmesh::fitting

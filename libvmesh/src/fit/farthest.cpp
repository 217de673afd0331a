#include "fit/farthest.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

Vec3 point_of(const FitMesh& surface, const Match& match) {
  const auto [a, b, c] = surface.corners(match.face);
  return match.weights[0] * a + match.weights[1] * b + match.weights[2] * c;
}

}  // namespace

Place place_of(const FitMesh& surface, const Match& match) {
  return {point_of(surface, match), surface.mean_edge(surface.faces[match.face][0])};
}

Match farthest_match(const FitMesh& surface, const Matches& matches, const std::vector<Place>& left_alone) {
  Match farthest;
  for (const auto* list : {&matches.from_surface, &matches.from_reference}) {
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
  const Triangle face = surface.faces[match.face];
  const Index a = face[(side + 1) % 3], b = face[(side + 2) % 3];
  if (surface.face_of(a, b) == kNone || surface.face_of(b, a) == kNone) return;
  const Vec3 p = point_of(surface, match) - match.distance * match.direction;
  const FitMesh::Vertex &first = surface.vertices[a], &second = surface.vertices[b];
  surface.split(a, b,
                {p, std::min(first.cone, second.cone), kNone, 0.5 * (first.size + second.size),
                 0.5 * (first.base_size + second.base_size)});
}

}  // namespace vmesh

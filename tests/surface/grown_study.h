#pragma once

#include "surface/pieces/piece_grower.h"
#include "surface/proof/refine_to_limit.h"

namespace vmesh::testing {

inline const Progress kSilent;

/// A trunk and two daughters, 20 times as long as wide.
inline Centerline long_fork() {
  return {{{{0, 0, -20}, 1}, {{0, 0, 0}, 1}, {{10, 0, 20}, 0.8}, {{-10, 0, 20}, 0.8}}, {{0, 1}, {1, 2}, {1, 3}}};
}

inline ErrorLimit relative_limit(double relative) {
  ErrorLimit limit;
  limit.relative = relative;
  return limit;
}

inline RefinementGoal goal_of(double relative, std::size_t most_vertices = 1'000'000) {
  return {relative_limit(relative), Placement::balanced, most_vertices};
}

/// Grown to be refined, with plain unions.
struct Study {
  explicit Study(const Centerline& vessels, double relative)
      : centerline(vessels),
        field(centerline, 0),
        open(centerline.nodes().size(), 0),
        grower(field, open, options(), relative_limit(relative), kSilent),
        first(grower.grow()) {}

  static GenerateOptions options() {
    GenerateOptions options;
    options.around = 18;
    options.blend = 0;
    return options;
  }

  Centerline centerline;
  VesselField field;
  std::vector<char> open;
  PieceGrower grower;
  Grown first;
};

}  // namespace vmesh::testing

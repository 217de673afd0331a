#pragma once

#include <algorithm>
#include <vector>

#include "vmesh/surface/error_bound.h"

#include "surface/remesh/sweep_state.h"

namespace vmesh {

/// Radii: beyond, the shell would reach the other side of the vessel; idle 0.35 to 0.7.
inline constexpr double kHighestShell = 0.5;

/// How far from a vertex on a vessel of that radius the shells of a proof reach, mm.
inline double shell_at(const ErrorLimit& limit, double radius) {
  return std::min(limit.at(radius), kHighestShell * radius);
}

/// Checks a surface under construction against a limit, again and again.
class ErrorLimitCheck {
 public:
  explicit ErrorLimitCheck(const ErrorLimit& limit) : limit_(limit) {}

  /// Faces for which the limit is not proven (see ErrorProof), ascending. What was proven and has not changed is not
  /// proven again. Faces at held vertices are skipped: they are proven on the whole surface, or lie at an opening.
  std::vector<Face> unproven_faces(const SweepState& state);

 private:
  struct Known {
    ErrorProof::Face face;
    ErrorProof::Shares shares;
  };

  ErrorLimit limit_;
  std::vector<Known> known_;  // by face
};

/// Groups faces that share vertices.
std::vector<UnprovenPlace> places_of(const TriMesh& mesh, const std::vector<Index>& faces);

}  // namespace vmesh

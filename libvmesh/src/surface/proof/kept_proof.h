#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "vmesh/surface/error_bound.h"

#include "surface/check/error_limit.h"
#include "surface/remesh/sweep_state.h"

namespace vmesh {

using FaceCorners = std::array<Vertex, 3>;

inline bool has(const FaceCorners& f, Vertex v) { return f[0] == v || f[1] == v || f[2] == v; }

/// The proof of a surface's error limit, kept while the surface changes step by step (ErrorProof). Faces that were not
/// proven at first, those around them, and faces at held vertices are fixed: no step may replace them or change what
/// holds for them.
class KeptProof {
 public:
  /// What a step changes in the proof.
  struct Outlook {
    std::vector<std::pair<Vertex, ErrorProof::Corner>> corners;
    std::vector<std::pair<FaceCorners, ErrorProof::Shares>> made;
    std::vector<std::pair<Face, ErrorProof::Shares>> kept;
  };

  /// Measures the surface as unproven_faces() does. Keeps references.
  KeptProof(const SweepState& state, const ErrorLimit& limit);

  bool is_fixed(Face f) const { return fixed_[f.idx()]; }

  /// What the step would change; nothing if a face would not be proven any more. Looks at the faces that the step
  /// replaces and at all that share a vertex with them.
  std::optional<Outlook> after(const SurfaceStep& step) const;

  /// Whether the surface would be proven after a step, of which after() told this. Looks farther around.
  bool holds(const SurfaceStep& step, const Outlook& outlook) const;

  /// Tells that the step has been taken. `v`: its vertex, as it is called now.
  void note(const SurfaceStep& step, const Outlook& outlook, Vertex v);

 private:
  // Faces as they will be after a step, with the shares of their shells.
  struct Surroundings {
    std::vector<std::pair<FaceCorners, ErrorProof::Shares>> faces;
    std::vector<Face> known;  // those of them that are there already
    bool at_fixed = false;

    bool are_even() const;
    std::vector<Vertex> vertices() const;
  };

  void fix_neighbours();
  ErrorProof::Corner corner_of(Vertex v) const;
  ErrorProof::Corner corner_after(const SurfaceStep& step, Vertex v) const;
  void add_around(Vertex v, const SurfaceStep& step, const Outlook& outlook, Surroundings& to) const;

  const SweepState& state_;
  const BoundSurface& surface_;
  const SurfaceMesh& mesh_;
  const ErrorLimit& limit_;
  ErrorProof proof_;
  std::vector<ErrorProof::Corner> corner_;  // by vertex
  std::vector<ErrorProof::Shares> shares_;  // by face
  std::vector<char> fixed_;
};

}  // namespace vmesh

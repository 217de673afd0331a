#pragma once

#include <functional>
#include <vector>

#include "vmesh/surface/error_bound.h"

#include "surface/proof/finished_surface.h"

namespace vmesh {

/// The proof of a surface that is refined. What has not changed is not proven again.
class RefinedProof {
 public:
  /// Keeps a reference to `field`.
  RefinedProof(const VesselField& field, bool bends_at_once) : proof_(field), bends_at_once_(bends_at_once) {}

  /// Faces that are not proven, ascending. `changed`: those that are new or have moved since the last call; the first
  /// looks at all. `limit_at`: mm, of a vertex; `is_far`: whether a face is known to be beyond it.
  std::vector<Index> unproven(const FinishedMesh& mesh, const std::vector<Index>& changed,
                              const std::function<double(Index)>& limit_at, const std::function<bool(Index)>& is_far);

 private:
  // Some faces, with vertices of their own.
  struct Part {
    std::vector<Index> faces;  // their numbers in the whole; ascending
    std::vector<ErrorProof::Corner> corners;
    std::vector<Triangle> triangles;
    std::vector<ErrorProof::Shares> shares;
  };

  std::vector<Index> update_corners(const FinishedMesh& mesh, const std::vector<Index>& changed,
                                    const std::function<double(Index)>& limit_at);
  std::vector<Index> low_faces(const FinishedMesh& mesh) const;
  Part part(const FinishedMesh& mesh, std::vector<Index> faces);

  ErrorProof proof_;
  const bool bends_at_once_;
  bool is_first_ = true;
  std::vector<ErrorProof::Corner> corners_;  // by vertex
  std::vector<ErrorProof::Shares> shares_;   // by face
  std::vector<Index> number_;                // of every vertex in a part; kNone between calls
};

}  // namespace vmesh

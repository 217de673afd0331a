#pragma once

#include <vector>

#include "vmesh/surface/error_bound.h"

namespace vmesh {

/// The proof of a surface that is proven again and again, each time with few changes (unproven_faces()): faces whose
/// corners are exactly those of a face of the first version, normals included, are not proven anew.
class SurfaceProof {
 public:
  /// Keeps a reference to the field.
  SurfaceProof(const VesselField& field, const ErrorLimit& limit) : field_(field), limit_(limit) {}

  /// Faces for which the limit is not proven, ascending. What the first call proves is known to the others.
  std::vector<Index> unproven(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding);

 private:
  using Corner = ErrorProof::Corner;
  using Shares = ErrorProof::Shares;

  void keep(const std::vector<Corner>& corners, const std::vector<Triangle>& faces, const std::vector<Shares>& shares);
  const Shares* find(const ErrorProof::Face& face) const;

  const VesselField& field_;
  const ErrorLimit limit_;
  // Of the first version.
  std::vector<Corner> corners_;
  std::vector<Triangle> faces_;
  std::vector<Shares> shares_;
  std::vector<Index> order_;  // faces, ascending by the place of their first corner
};

}  // namespace vmesh

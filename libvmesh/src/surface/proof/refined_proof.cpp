#include "surface/proof/refined_proof.h"

#include <utility>

#include <tbb/parallel_for.h>

namespace vmesh {
namespace {

constexpr std::size_t kMany = 100;  // one of so many faces is unproven: shells are not bent yet

}  // namespace

std::vector<Index> RefinedProof::unproven(const FinishedMesh& mesh, const std::vector<Index>& changed,
                                          const std::function<double(Index)>& limit_at,
                                          const std::function<bool(Index)>& is_far) {
  corners_.resize(mesh.vertices().size());
  known_.resize(mesh.faces().size());
  const auto update = [&](Index v) {
    if (mesh.has_vertex(v))
      corners_[v] = {mesh.position(v), mesh.middle_normal(v), limit_at(v), mesh.vertex(v).binding.segment};
  };
  if (is_first_) {
    for (Index v = 0; v < corners_.size(); ++v) update(v);
  } else {
    for (const Index f : changed) {
      if (!mesh.has_face(f)) continue;
      for (const Index v : mesh.faces()[f]) update(v);
    }
  }
  is_first_ = false;
  std::vector<Index> faces;
  std::vector<Triangle> triangles;
  for (Index f = 0; f < mesh.faces().size(); ++f) {
    if (!mesh.has_face(f)) continue;
    faces.push_back(f);
    triangles.push_back(mesh.faces()[f]);
  }
  std::vector<ErrorProof::Shares> shares(faces.size());
  tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) {
    const auto& [a, b, c] = triangles[i];
    const ErrorProof::Face face = {corners_[a], corners_[b], corners_[c]};
    Known& known = known_[faces[i]];
    if (known.face != face) known = {face, is_far(faces[i]) ? ErrorProof::Shares{} : proof_.shares(face)};
    shares[i] = known.shares;
  });
  std::vector<Index> left = proof_.unproven(corners_, triangles, shares);
  if (!left.empty() && (bends_at_once_ || left.size() < faces.size() / kMany)) {
    std::vector<Index> if_bent = proof_.unproven_if_bent(corners_, triangles, shares);  // neighbours may lose by it
    if (if_bent.size() < left.size()) left = std::move(if_bent);
  }
  for (Index& i : left) i = faces[i];
  return left;
}

}  // namespace vmesh

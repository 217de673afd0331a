#include "surface/check/surface_proof.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include <tbb/parallel_for.h>

#include "vmesh/mesh/triangle_quality.h"

namespace vmesh {
namespace {

using Corners = std::vector<ErrorProof::Corner>;

Corners corners_of(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding, const VesselField& field,
                   const ErrorLimit& limit) {
  Corners corners(mesh.vertices.size());
  for (Index v = 0; v < corners.size(); ++v) {
    const auto& [cone, t] = binding[v];
    corners[v] = {mesh.vertices[v], Vec3::Zero(), limit.at(field.relations().radius_at(cone, t)), cone};
  }
  for (const Triangle& face : mesh.faces) {
    for (std::size_t k = 0; k < 3; ++k)
      corners[face[k]].normal +=
          angle_normal(mesh.vertices[face[k]], mesh.vertices[face[(k + 1) % 3]], mesh.vertices[face[(k + 2) % 3]]);
  }
  for (ErrorProof::Corner& v : corners) v.normal.normalize();
  return corners;
}

bool is_before(const Vec3& p, const Vec3& q) { return std::tie(p.x(), p.y(), p.z()) < std::tie(q.x(), q.y(), q.z()); }

template <class SharesOf>
std::vector<ErrorProof::Shares> all_shares(const std::vector<Triangle>& faces, const SharesOf& shares_of) {
  std::vector<ErrorProof::Shares> shares(faces.size());
  tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t f) { shares[f] = shares_of(faces[f]); });
  return shares;
}

std::vector<Index> unproven_with(const ErrorProof& proof, const Corners& corners, const std::vector<Triangle>& faces,
                                 const std::vector<ErrorProof::Shares>& shares, Shells shells) {
  std::vector<Index> unproven = proof.unproven(corners, faces, shares);
  if (unproven.empty() || shells == Shells::along_normals) return unproven;
  std::vector<Index> if_bent = proof.unproven_if_bent(corners, faces, shares);  // neighbours may lose by it
  return if_bent.size() < unproven.size() ? if_bent : unproven;
}

}  // namespace

std::vector<Index> SurfaceProof::unproven(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding) {
  const Corners corners = corners_of(mesh, binding, field_, limit_);
  const ErrorProof proof(field_);
  const std::vector<Shares> shares = all_shares(mesh.faces, [&](const Triangle& f) {
    const ErrorProof::Face face = ErrorProof::face_of(corners, f);
    const Shares* known = find(face);
    return known ? *known : proof.shares(face);
  });
  if (order_.empty()) keep(corners, mesh.faces, shares);
  return unproven_with(proof, corners, mesh.faces, shares, Shells::bent);
}

void SurfaceProof::keep(const Corners& corners, const std::vector<Triangle>& faces, const std::vector<Shares>& shares) {
  corners_ = corners;
  faces_ = faces;
  shares_ = shares;
  order_.resize(faces.size());
  std::iota(order_.begin(), order_.end(), Index{0});
  std::sort(order_.begin(), order_.end(), [&](Index f, Index g) {
    return is_before(corners_[faces_[f][0]].position, corners_[faces_[g][0]].position);
  });
}

const ErrorProof::Shares* SurfaceProof::find(const ErrorProof::Face& face) const {
  const Vec3& first = face[0].position;
  auto it = std::lower_bound(order_.begin(), order_.end(), first,
                             [&](Index f, const Vec3& p) { return is_before(corners_[faces_[f][0]].position, p); });
  for (; it != order_.end() && corners_[faces_[*it][0]].position == first; ++it) {
    if (ErrorProof::face_of(corners_, faces_[*it]) == face) return &shares_[*it];
  }
  return nullptr;
}

std::vector<Index> unproven_faces(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                                  const VesselField& field, const ErrorLimit& limit, Shells shells) {
  const Corners corners = corners_of(mesh, binding, field, limit);
  const ErrorProof proof(field);
  const auto shares =
      all_shares(mesh.faces, [&](const Triangle& f) { return proof.shares(ErrorProof::face_of(corners, f)); });
  return unproven_with(proof, corners, mesh.faces, shares, shells);
}

}  // namespace vmesh

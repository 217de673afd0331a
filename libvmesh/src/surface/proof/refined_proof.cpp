#include "surface/proof/refined_proof.h"

#include <utility>

#include <tbb/parallel_for.h>

#include "vmesh/core/ascending.h"

namespace vmesh {
namespace {

constexpr std::size_t kMany = 100;  // one of so many faces is unproven: shells are not bent yet
constexpr int kBentRings = 6;       // derived: bending goes on for four rounds, each of them changes the next faces

std::vector<Index> all_faces(const FinishedMesh& mesh) {
  std::vector<Index> faces;
  for (Index f = 0; f < mesh.faces().size(); ++f) {
    if (mesh.has_face(f)) faces.push_back(f);
  }
  return faces;
}

// Adds the faces beside these.
void add_ring(const FinishedMesh& mesh, std::vector<Index>& faces) {
  std::vector<Index> vertices;
  for (const Index f : faces) vertices.insert(vertices.end(), mesh.faces()[f].begin(), mesh.faces()[f].end());
  sort_unique(vertices);
  for (const Index v : vertices) {
    const auto& fan = mesh.faces_around(v);
    faces.insert(faces.end(), fan.begin(), fan.end());
  }
  sort_unique(faces);
}

}  // namespace

std::vector<Index> RefinedProof::unproven(const FinishedMesh& mesh, const std::vector<Index>& changed,
                                          const std::function<double(Index)>& limit_at,
                                          const std::function<bool(Index)>& is_far) {
  const std::vector<Index> due = update_corners(mesh, changed, limit_at);
  shares_.resize(mesh.faces().size());
  tbb::parallel_for(std::size_t{0}, due.size(), [&](std::size_t i) {
    const Index f = due[i];
    shares_[f] = is_far(f) ? ErrorProof::Shares{} : proof_.shares(ErrorProof::face_of(corners_, mesh.faces()[f]));
  });
  // Elsewhere shells are as high as the limit.
  std::vector<Index> low = low_faces(mesh);
  add_ring(mesh, low);
  const Part lowered = part(mesh, low);
  std::vector<Index> left = proof_.unproven(lowered.corners, lowered.triangles, lowered.shares);
  for (Index& i : left) i = lowered.faces[i];
  if (left.empty() || !(bends_at_once_ || left.size() < mesh.faces().size() / kMany)) return left;
  std::vector<Index> around = left;
  for (int ring = 0; ring < kBentRings; ++ring) add_ring(mesh, around);
  low.insert(low.end(), around.begin(), around.end());
  sort_unique(low);
  const Part bent = part(mesh, std::move(low));
  std::vector<Index> if_bent = proof_.unproven_if_bent(bent.corners, bent.triangles, bent.shares);
  if (if_bent.size() >= left.size()) return left;  // neighbours may lose by it
  for (Index& i : if_bent) i = bent.faces[i];
  return if_bent;
}

// Returns the faces whose corners are not what they were, ascending.
std::vector<Index> RefinedProof::update_corners(const FinishedMesh& mesh, const std::vector<Index>& changed,
                                                const std::function<double(Index)>& limit_at) {
  corners_.resize(mesh.vertices().size());
  const auto corner_at = [&](Index v) {
    return ErrorProof::Corner{mesh.position(v), mesh.middle_normal(v), limit_at(v), mesh.vertex(v).binding.segment};
  };
  if (is_first_) {
    is_first_ = false;
    for (Index v = 0; v < corners_.size(); ++v) {
      if (mesh.has_vertex(v)) corners_[v] = corner_at(v);
    }
    return all_faces(mesh);
  }
  std::vector<Index> due;
  for (const Index f : changed) {
    if (!mesh.has_face(f)) continue;
    due.push_back(f);
    for (const Index v : mesh.faces()[f]) {
      const ErrorProof::Corner corner = corner_at(v);
      if (corner == corners_[v]) continue;
      corners_[v] = corner;
      const auto& fan = mesh.faces_around(v);
      due.insert(due.end(), fan.begin(), fan.end());
    }
  }
  sort_unique(due);
  return due;
}

std::vector<Index> RefinedProof::low_faces(const FinishedMesh& mesh) const {
  std::vector<Index> low;
  for (Index f = 0; f < shares_.size(); ++f) {
    if ((shares_[f].inner < 1 || shares_[f].outer < 1) && mesh.has_face(f)) low.push_back(f);
  }
  return low;
}

RefinedProof::Part RefinedProof::part(const FinishedMesh& mesh, std::vector<Index> faces) {
  Part part;
  number_.resize(mesh.vertices().size(), kNone);
  std::vector<Index> vertices;
  for (const Index f : faces) {
    Triangle face = mesh.faces()[f];
    for (Index& v : face) {
      if (number_[v] == kNone) {
        number_[v] = static_cast<Index>(vertices.size());
        vertices.push_back(v);
        part.corners.push_back(corners_[v]);
      }
      v = number_[v];
    }
    part.triangles.push_back(face);
    part.shares.push_back(shares_[f]);
  }
  for (const Index v : vertices) number_[v] = kNone;
  part.faces = std::move(faces);
  return part;
}

}  // namespace vmesh

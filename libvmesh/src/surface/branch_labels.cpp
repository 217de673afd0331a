#include "vmesh/surface/branch_labels.h"

#include <algorithm>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/error.h"

namespace vmesh {

void check_bindings(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding, std::size_t cones) {
  if (binding.size() != mesh.vertices.size()) {
    throw InvalidInput("branch labels: there are " + std::to_string(mesh.vertices.size()) + " vertices and " +
                       std::to_string(binding.size()) + " bindings; every vertex needs one");
  }
  for (std::size_t v = 0; v < binding.size(); ++v) {
    if (binding[v].segment >= cones) {
      throw InvalidInput("branch labels: vertex " + std::to_string(v) + " is bound to segment " +
                         std::to_string(binding[v].segment) + ", which the centerline does not have");
    }
  }
}

std::vector<Index> branch_label_of_cones(const Centerline& centerline) {
  const BranchTable branches(centerline);
  std::vector<Index> labels(centerline.segments().size(), kNone);
  for (Index b = 0; b < branches.size(); ++b) {
    for (const Index s : branches.segments(b)) labels[s] = b;
  }
  auto next = static_cast<Index>(branches.size());
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    if (centerline.degree(n) == 0) labels.push_back(next++);
  }
  return labels;
}

Index label_of_face(Index a, Index b, Index c) { return b == c ? b : a == b || a == c ? a : std::min({a, b, c}); }

BranchLabels label_branches(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                            const Centerline& centerline) {
  const std::vector<Index> label_of = branch_label_of_cones(centerline);
  check_bindings(mesh, binding, label_of.size());
  BranchLabels labels;
  for (const CenterlineBinding& at : binding) labels.vertex.push_back(label_of[at.segment]);
  for (const auto& [a, b, c] : mesh.faces) {
    labels.face.push_back(label_of_face(labels.vertex[a], labels.vertex[b], labels.vertex[c]));
  }
  return labels;
}

}  // namespace vmesh

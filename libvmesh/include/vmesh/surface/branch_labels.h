#pragma once

#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// Which branch of a centerline each vertex and face of its surface belongs to. A label is an index into
/// find_branches(); isolated node i of the centerline (a sphere, which is not a branch) has the label
/// find_branches().size() + its rank among isolated nodes, as CenterlineBinding counts segments.
struct BranchLabels {
  std::vector<Index> vertex;  ///< one per vertex: the branch of the segment it is bound to
  std::vector<Index> face;    ///< one per face: the label of most of its corners
};

/// The label of every segment, then of every isolated node.
std::vector<Index> branch_label_of_cones(const Centerline& centerline);

/// Throws InvalidInput unless every vertex is bound to one of `cones` segments and isolated nodes.
void check_bindings(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding, std::size_t cones);

/// The label of a face whose corners have these labels.
Index label_of_face(Index a, Index b, Index c);

/// Labels a surface that was grown around `centerline`; `binding` has one entry per vertex of `mesh`. A face whose
/// three corners differ gets the lowest of their labels, which in canonical order (see CleaningOptions) is the branch
/// nearest to the root. Throws InvalidInput when `binding` is not as long as the vertices or names a segment that does
/// not exist.
BranchLabels label_branches(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                            const Centerline& centerline);

}  // namespace vmesh

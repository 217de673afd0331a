#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/flat_ends.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// The attributes written with a surface around a centerline. Per vertex: radius, segment and parameter of the binding,
/// branch, and for an open surface, opening (from 1; 0: none). Per face: skewness and branch.
MeshAttributes surface_attributes(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                                  const std::vector<double>& radius, const std::vector<Opening>& openings,
                                  const Centerline& centerline);

/// The same for some vertices or faces at a time: for surfaces that are written block by block.
class AttributeBlocks {
 public:
  /// All but the centerline must outlive it. Throws InvalidInput like label_branches().
  AttributeBlocks(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding, const std::vector<double>& radius,
                  const std::vector<Opening>& openings, const Centerline& centerline);

  /// Of the vertices from number `begin` to `end`, excluded.
  std::vector<MeshAttribute> of_vertices(std::size_t begin, std::size_t end) const;
  std::vector<MeshAttribute> of_faces(std::size_t begin, std::size_t end) const;

 private:
  Index branch_of(Index vertex) const { return label_[binding_[vertex].segment]; }

  const TriMesh& mesh_;
  const std::vector<CenterlineBinding>& binding_;
  const std::vector<double>& radius_;
  bool has_openings_;
  std::vector<std::pair<Index, Index>> opening_;  // of vertices that belong to one, ascending
  std::vector<Index> label_;                      // of cones
};

/// What a user calls the end of a vessel.
struct EndName {
  Index node = kNone;  ///< of the centerline
  std::string name;
};

/// The name given to the end, or "cap_" and its label.
std::string name_of_end(const FlatEnd& end, const std::vector<EndName>& names);

/// Adds SimVascular's face labels: ModelFaceID, 1 for the wall and from 2 on for caps, and CapID, -1 for the wall; and
/// the names of these patches: "wall", then name_of_end().
void add_cap_labels(const FlatEnds& ends, MeshAttributes& attributes, const std::vector<EndName>& names = {});

/// Divides the wall (all faces whose ModelFaceID is 1, or all faces if there is none) by the branches of its faces,
/// their attribute "branch", into the patches "wall_0", "wall_2" ..., which are numbered from 1 in ascending order;
/// caps follow. Returns how many parts the wall has.
Index divide_wall(MeshAttributes& attributes);

}  // namespace vmesh

#pragma once

#include <span>
#include <vector>

#include "vmesh/core/box_tree.h"

#include "volume/cone_axes.h"
#include "volume/contact_pairs.h"

namespace vmesh {

/// Some cones of a centerline as a centerline of their own.
struct RelationExcerpt {
  Centerline centerline;
  std::vector<Index> cone;    ///< their numbers in the whole; ascending
  std::vector<char> is_near;  ///< whether it is one of those of which everything is known
};

/// The box of a cone, grown as the question asks for (ContactQuestion::reach).
BoxTree::Box grown_box(const ConeAxes& cones, Index cone, const ContactQuestion& question);

/// Takes parts of a centerline whose ConeRelations agree with those of the whole.
///
/// Pairs of spheres are related where one can be reached from two copies of one sphere by moving either along the
/// graph, so a part that ends at a node is complete if all spheres that the node's may face form one stretch of vessel
/// around it, and the part has all of them: whatever is reached by a detour beyond the node comes back to that stretch,
/// which is reached without it.
class RelationExcerpts {
 public:
  /// `less_rounded`: of every cone, whether less than all of the blend is left to it. All must outlive it.
  RelationExcerpts(const ConeAxes& cones, const ContactQuestion& question, const std::vector<char>& less_rounded);

  /// Adds the cones whose boxes (grown_box) overlap a box.
  void add_near(const BoxTree::Box& box, std::vector<Index>& near) const;

  /// The cones on whose relations those of `cones` (ascending) may have an influence, and those up to `beyond` mean
  /// radii farther along the graph; ascending.
  std::vector<Index> influenced_by(const std::vector<Index>& cones, double beyond = 0) const;

  /// A part in which all relations of `cones` (ascending) are known, and those of the cones near them.
  RelationExcerpt take(const std::vector<Index>& cones) const;
  /// The same, without what is near in space but not along the graph.
  RelationExcerpt take_alone(const std::vector<Index>& cones) const;

 private:
  bool ends_at(Index node, std::vector<Index>& all) const;
  std::vector<Index> faced_at(Index node) const;
  RelationExcerpt part(const std::vector<Index>& cones, const std::vector<Index>& near) const;
  bool may_face(Index node, Index cone) const;
  bool faces_node(Index node, Index other) const;

  const ConeAxes& cones_;
  const ContactQuestion& question_;
  const std::vector<char>& less_rounded_;
  Touch widest_;
  BoxTree tree_;
};

}  // namespace vmesh

#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "volume/divided_centerline.h"

namespace vmesh {

/// The share of its radius that a vessel keeps: 1, or less where it is held. From there the share returns to 1 along
/// the graph by `taper` per radius of length. Every segment is divided evenly into leaves of at most half its smaller
/// radius; shares are held at their ends.
class Narrowing {
 public:
  Narrowing(const Centerline& original, double taper);

  Index leaf_count(Index segment) const { return leaf_counts_[segment]; }
  /// The vessel keeps at most `share` of its radius all along a leaf of `segment`.
  void hold(Index segment, Index leaf, double share);
  void hold_node(Index node, double share);

  DividedCenterline apply() const;

 private:
  /// A place where the share is held: the end of a leaf inside a segment, or a node.
  struct Post {
    double t = 0;
    Index place = kNone;  // index into shares and neighbours
  };
  struct Posts {
    std::vector<std::vector<Post>> on_segment;  // along every segment, its nodes at the ends
    std::vector<double> shares;                 // of all nodes, then of the leaf ends
  };

  struct InnerNode {
    double t, radius;
  };

  Posts plant_posts() const;
  void let_shares_return(Posts& posts) const;
  // The nodes between the ends of a segment, in order.
  std::vector<InnerNode> inner_nodes(Index segment, const Posts& posts) const;
  bool is_held_leaf(Index segment, const Post& p, const Post& q) const;
  double radius_at(Index segment, const Post& post) const { return original_->radius_at(segment, post.t); }
  double length_between(Index segment, const Post& p, const Post& q) const {
    return (q.t - p.t) * original_->length(segment);
  }

  const Centerline* original_;
  double taper_;
  std::vector<Index> leaf_counts_;
  std::vector<double> node_shares_;
  std::map<std::pair<Index, Index>, double> leaf_shares_;  // (segment, number of the leaf end)
  std::set<std::pair<Index, Index>> held_leaves_;          // (segment, leaf)
};

}  // namespace vmesh

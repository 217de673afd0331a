#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Finds faces of a mesh that come close: those whose boxes overlap. Faces are ordered along a space-filling curve,
/// eight to a block, with a binary tree over the blocks. Boxes are in single precision, rounded outwards.
class CloseFaces {
 public:
  /// `faces`: the numbers of the faces that take part. O(n log n).
  CloseFaces(const TriMesh& mesh, std::vector<Index> faces);
  /// The same for pairs of faces of different parts only. `parts`: the part of every face in `faces`, ascending.
  CloseFaces(const TriMesh& mesh, std::vector<Index> faces, std::vector<Index> parts);

  /// Calls visit(face, face) once for every two faces whose boxes overlap, and for some whose boxes nearly do.
  template <class Visit>
  void visit_pairs(Visit&& visit) const {
    for (std::size_t block = 0; block < blocks_; ++block) visit_pairs_of(block, visit);
  }

  /// The same for one block at a time, in any order.
  std::size_t block_count() const { return blocks_; }
  template <class Visit>
  void visit_pairs_of(std::size_t block, Visit&& visit) const {
    visit_within(block, visit);
    visit_later(1, block, visit);
  }

 private:
  static constexpr std::size_t kBlock = 8;
  struct Box {
    std::array<float, 3> low, high;

    bool meets(const Box& other) const {
      // All six comparisons at once: a branch for each costs more.
      return (low[0] <= other.high[0]) & (other.low[0] <= high[0]) & (low[1] <= other.high[1]) &
             (other.low[1] <= high[1]) & (low[2] <= other.high[2]) & (other.low[2] <= high[2]);
    }
    void enclose(const Box& other);
  };

  static Box box_of(const TriMesh& mesh, Index face);
  // Sorts the faces from number `begin` to `end`.
  void sort(const TriMesh& mesh, std::size_t begin, std::size_t end);
  void build(const TriMesh& mesh);
  void note_parts();
  bool are_apart(std::size_t i, std::size_t j) const { return part_.empty() || part_[i] != part_[j]; }
  bool are_one_part(std::size_t node, std::size_t other) const {
    return !part_.empty() && part_below_[node] != kNone && part_below_[node] == part_below_[other];
  }

  std::size_t end_of(std::size_t block) const { return std::min(faces_.size(), (block + 1) * kBlock); }

  template <class Visit>
  void visit_within(std::size_t block, Visit& visit) const {
    if (are_one_part(leaves_ + block, leaves_ + block)) return;
    for (std::size_t i = block * kBlock; i < end_of(block); ++i) {
      for (std::size_t j = block * kBlock; j < i; ++j) {
        if (boxes_[i].meets(boxes_[j]) && are_apart(i, j)) visit(faces_[i], faces_[j]);
      }
    }
  }

  // The faces of a block with those of the later ones below a node.
  template <class Visit>
  void visit_later(std::size_t node, std::size_t block, Visit& visit) const {
    if (last_block_[node] <= block + 1 || !nodes_[node].meets(nodes_[leaves_ + block])) return;
    if (are_one_part(node, leaves_ + block)) return;
    if (node < leaves_) {
      visit_later(2 * node, block, visit);
      visit_later(2 * node + 1, block, visit);
      return;
    }
    const std::size_t other = node - leaves_;
    for (std::size_t i = block * kBlock; i < end_of(block); ++i) {
      if (!boxes_[i].meets(nodes_[node])) continue;
      for (std::size_t j = other * kBlock; j < end_of(other); ++j) {
        if (boxes_[i].meets(boxes_[j]) && are_apart(i, j)) visit(faces_[i], faces_[j]);
      }
    }
  }

  std::vector<Index> faces_;             // along the curve
  std::vector<Box> boxes_;               // of faces_
  std::size_t blocks_ = 0, leaves_ = 1;  // a power of two
  // Node 1 is the root, the children of node n are 2 n and 2 n + 1; from leaves_ on, nodes are blocks.
  std::vector<Box> nodes_;
  std::vector<Index> last_block_;  // below a node, counted from one; 0: none
  std::vector<Index> part_;        // of every face; empty: all pairs count
  std::vector<Index> part_below_;  // the part of all faces below a node, if it is a single one
};

}  // namespace vmesh

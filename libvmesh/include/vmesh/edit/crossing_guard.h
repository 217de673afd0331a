#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "vmesh/core/box_tree.h"
#include "vmesh/core/changing_box_tree.h"
#include "vmesh/edit/refused_steps.h"
#include "vmesh/mesh/face_pair.h"

namespace vmesh {

/// Tells whether a step would make faces of a surface cross each other, or cross an axis line that they did not cross
/// before. Keeps all faces, and their boxes in a tree; those that are new, have changed or are removed must be
/// announced (touch).
class CrossingGuard {
 public:
  using AxisLine = std::array<Vec3, 2>;
  /// A face as it is now; nothing if it has been removed or does not count.
  using FaceLookup = std::function<std::optional<PlacedFace>(Index)>;

  /// `faces`: numbers so far. `axes`: the axis lines, which belong inside.
  CrossingGuard(std::size_t faces, FaceLookup face_at, std::vector<AxisLine> axes = {});

  /// Whether faces may be replaced by others.
  bool allows(const std::vector<PlacedFace>& faces, const std::vector<Index>& gone) const;

  /// The face is new, has changed or has been removed.
  void touch(Index f);

  /// The steps that were not allowed so far.
  const RefusedSteps& refused() const { return refused_; }

 private:
  bool has(Index f) const { return faces_[f].vertices[0] != kNone; }
  void make_anew();
  // Notes a search for faces that looked at `visited` boxes and found this many.
  void note_search(std::size_t visited, std::size_t found) const;
  bool cross_others(const std::vector<PlacedFace>& faces, const std::vector<Index>& gone) const;
  // Whether one of `faces` meets an axis line that none of `gone` meets.
  bool cross_axes(const std::vector<PlacedFace>& faces, const std::vector<Index>& gone) const;

  FaceLookup face_at_;
  // As announced last, by number; a first vertex of kNone: there is none.
  std::vector<PlacedFace> faces_;
  // Of all faces, and of some that have been removed since.
  ChangingBoxTree boxes_;
  mutable std::size_t visited_in_vain_ = 0;  // boxes, since the tree was made
  std::vector<AxisLine> axes_;
  BoxTree axis_tree_;  // of the parts of axis lines
  mutable RefusedSteps refused_;
};

/// Pairs of faces that cross, of which at least one is among `changed`; for a surface in which no others do, such as an
/// EditMesh's. The smaller number first.
std::vector<std::pair<Index, Index>> crossing_pairs(const std::vector<Vec3>& positions,
                                                    const std::vector<Triangle>& faces,
                                                    const std::vector<Index>& changed);

}  // namespace vmesh

#pragma once

#include <map>
#include <vector>

#include "volume/divided_centerline.h"

namespace vmesh {

/// A stretch of a segment of the original centerline that is to be moved, or an isolated node (segment kNone).
struct MovedStretch {
  Index segment = kNone;
  double t_first = 0, t_last = 1;
  Index node = kNone;
};

/// Moves stretches of a centerline aside. Each shift moves some stretches by the same vector; along the graph, also
/// across branching nodes, it fades out smoothly over a length that bounds its slope. A shift does not rotate anything,
/// and its slope is below 1, so nothing folds. Shifts add up.
class Moving {
 public:
  struct Shift {
    Vec3 direction = Vec3::Zero();  // unit
    double distance = 0;            // mm
    std::vector<MovedStretch> stretches;
    ContactSide moved, other;  // where it was first needed, on the original
    int extensions = 0;
  };

  /// `slope`: largest change of a shift's distance per length of the original.
  Moving(const Centerline& original, double slope);

  const std::vector<Shift>& shifts() const { return shifts_; }
  /// Adds a shift and returns its number. If all shifts together would displace the axis too steeply, changes nothing
  /// and returns kNone.
  Index add(Shift shift);
  /// Extends a shift: its distance becomes at least `distance`, and it moves `more` stretches. Returns false and
  /// changes nothing if that is too steep, hardly an increase, or has been done too often.
  bool extend(Index shift, double distance, const std::vector<MovedStretch>& more);
  void remove(Index shift);

  /// The share of its distance by which a shift moves a place of the original, in [0, 1].
  double part_at(Index shift, const MovedStretch& place) const;
  /// Largest change of the total displacement per length of the original.
  double steepest() const;
  DividedCenterline apply() const;

 private:
  struct Step {
    Index place;
    double length;
  };
  void fade(Index shift);
  double fading_length(const Shift& shift) const;
  Index place_of(Index segment, Index leaf_end) const;
  Index leaf_end_of(Index place) const { return place - offsets_[segment_of(place)] + 1; }
  Index segment_of(Index place) const { return segments_[place - original_->nodes().size()]; }
  bool is_node(Index place) const { return place < original_->nodes().size(); }
  std::vector<Index> places_of(const MovedStretch& stretch) const;
  std::vector<Step> steps_from(Index place) const;
  Vec3 displacement_at(Index place) const;
  std::map<Index, Vec3> displacements() const;
  double steepest_along(Index shift) const;
  bool is_more(Index shift, double distance, const std::vector<MovedStretch>& stretches) const;
  std::map<Index, std::vector<Index>> divisions(const std::map<Index, Vec3>& displaced) const;
  double radius_of(Index place) const;

  const Centerline* original_;
  double slope_;
  std::vector<Index> leaf_counts_, offsets_;  // per segment; offset of its inner leaf ends among all places
  std::vector<Index> segments_;               // of every inner leaf end
  std::vector<Shift> shifts_;
  std::vector<std::map<Index, double>> parts_;  // per shift, of the places it moves
};

}  // namespace vmesh

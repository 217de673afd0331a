#pragma once

#include <map>
#include <vector>

#include "volume/divided_centerline.h"

namespace vmesh {

/// A part of a segment of the original centerline that is to be moved; of an isolated node, with segment kNone.
struct MovedStretch {
  Index segment = kNone;
  double t_first = 0, t_last = 1;
  Index node = kNone;
};

/// Moves stretches of a centerline aside. Each shift moves some stretches by the same vector; along the graph, across
/// branching nodes too, it fades out smoothly over a length that bounds its slope. A shift turns nothing and its slope
/// is below 1, so that it folds nothing either. Shifts add up.
class Moving {
 public:
  struct Shift {
    Vec3 direction = Vec3::Zero();  // unit
    double distance = 0;            // mm
    std::vector<MovedStretch> stretches;
    ContactSide moved, other;  // where it was first asked for, on the original
    int extensions = 0;
  };

  /// `slope`: the most that the distance of a shift changes per length of the original.
  Moving(const Centerline& original, double slope);

  const std::vector<Shift>& shifts() const { return shifts_; }
  /// Adds a shift, and returns its number. Where the axis would go aside too steeply, all shifts together, nothing is
  /// changed and kNone returned.
  Index add(Shift shift);
  /// Moves further, or more: the shift's distance becomes at least `distance`. Returns false and changes nothing where
  /// that is too steep, hardly any more, or has been done too often.
  bool extend(Index shift, double distance, const std::vector<MovedStretch>& more);
  void remove(Index shift);

  /// By how much of its distance a shift moves a place of the original, in [0, 1].
  double part_at(Index shift, const MovedStretch& place) const;
  /// The most that the displacement, of all shifts together, changes per length of the original.
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

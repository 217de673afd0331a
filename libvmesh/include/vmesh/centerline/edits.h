// Changes of vessels for studies: another stenosis, a branch less.
#pragma once

#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/centerline/end_section.h"

namespace vmesh {

/// The radius changes around a node: at distance d along the vessels, on all branches, by the factor
/// 1 + share (1 + cos(2 pi d / length)) / 2, up to half of `length`.
struct RadiusChange {
  Index node = kNone;
  double length = 0;  ///< mm, > 0
  double share = 0;   ///< > -1; -.5 is a stenosis of half of the diameter, .5 an aneurysm that is as much wider
};

struct CenterlineEdit {
  std::vector<RadiusChange> radius = {};  ///< multiplied where they overlap
  /// In find_branches(). With each goes what it joins to the thickest end of its component.
  std::vector<Index> removed_branches = {};
  double scale = 1;  ///< of all lengths, about the origin; applied last
};

struct EditedCenterline {
  Centerline centerline;
  std::vector<EndSection> end_sections;
  /// For the nodes that come first, the original node; new ones, which follow the profile of the radius, come after
  /// them.
  std::vector<Index> original;
};

/// The radii of changed vessels, at every place of the original.
class ChangedRadius {
 public:
  /// Throws InvalidInput for a node that does not exist, a length that is not positive and a share that is not above
  /// -1.
  ChangedRadius(const Centerline& centerline, std::vector<RadiusChange> changes);

  /// By which the radius at parameter `t` of a segment is multiplied; `segment` may be an isolated node's, counted
  /// after all segments in the order of these nodes.
  double factor(Index segment, double t) const;
  double factor_at_node(Index node) const;

  /// Parameters at which the radius is to be known so that it follows the profile, 0 and 1 left out; ascending.
  std::vector<double> steps(Index segment) const;

 private:
  double distance(std::size_t change, Index segment, double t) const;

  const Centerline* centerline_;
  std::vector<RadiusChange> changes_;
  std::vector<Index> isolated_;
  std::vector<std::vector<double>> distance_;  // of every node from each change's, mm; infinite beyond its reach
};

/// Applies an edit. Flat ends of vessels that stay are kept, as wide as the vessels there. Throws InvalidInput as
/// ChangedRadius does, for a branch that does not exist, a scale that is not positive and finite, and if nothing is
/// left.
EditedCenterline edit_centerline(const Centerline& centerline, const CenterlineEdit& edit,
                                 const std::vector<EndSection>& end_sections = {});

}  // namespace vmesh

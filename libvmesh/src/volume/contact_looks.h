#pragma once

#include <optional>
#include <vector>

#include "volume/contact_pairs.h"
#include "volume/divided_centerline.h"
#include "volume/relation_excerpt.h"

namespace vmesh {

/// Finds the contacts of vessels that are narrowed and moved round by round. Looks only around what differs from
/// vessels looked at before; what it finds is what find_contact_pairs() would.
class ContactLooks {
 public:
  explicit ContactLooks(const ContactQuestion& question) : question_(question) {}

  /// `vessels` divide the same centerline every time. `round` may be any number: those looked at last with the same one
  /// are likely to differ least.
  const std::vector<ContactPair>& look(DividedCenterline vessels, std::size_t round);

  /// Signed distance at `p` to the nearest cone of the vessels looked at last that is not local to `cone`, if that is
  /// less than `limit` (mm), else `limit`.
  double distance_to_others(const Vec3& p, Index cone, double limit) const;

 private:
  struct Known {
    DividedCenterline vessels;
    std::vector<ContactPair> pairs;
  };
  struct Differences {
    std::vector<Index> old_cones, new_cones;  ///< that the others do not have
    std::vector<Index> new_number;            ///< of every old cone; kNone for those of old_cones
  };

  static Differences differences(const DividedCenterline& before, const DividedCenterline& after);
  std::size_t rounds_kept(std::size_t cones) const;
  std::vector<ContactPair> all_pairs(const Centerline& vessels) const;
  std::vector<ContactPair> updated(const Known& before, const DividedCenterline& after,
                                   const Differences& differences) const;

  ContactQuestion question_;
  std::vector<std::optional<Known>> known_;  // by round
  std::size_t last_ = 0;                     // looked at
};

}  // namespace vmesh

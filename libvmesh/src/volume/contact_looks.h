#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "vmesh/volume/vessel_field.h"

#include "volume/contact_pairs.h"
#include "volume/divided_centerline.h"
#include "volume/relation_excerpt.h"

namespace vmesh {

/// Finds the contacts of vessels that are narrowed and moved round by round. Looks only around what differs from
/// vessels looked at before; what it finds is what find_contact_pairs() would.
class ContactLooks {
 public:
  /// `at_all`: looks at everything every time.
  explicit ContactLooks(const ContactQuestion& question, bool at_all = false) : question_(question), at_all_(at_all) {}

  /// `vessels` divide the same centerline every time. `round` may be any number: those looked at last with the same one
  /// are likely to differ least.
  const std::vector<ContactPair>& look(DividedCenterline vessels, std::size_t round);

  /// Signed distance at `p` to the nearest cone of the vessels looked at last that is not local to `cone`, if that is
  /// less than `limit` (mm), else `limit`.
  double distance_to_others(const Vec3& p, Index cone, double limit) const;

 private:
  struct Found {
    std::vector<ContactPair> pairs;
    std::vector<char> less_rounded;  // of cones: whether less than all of the blend is left to them
  };
  struct Known {
    DividedCenterline vessels;
    Found found;
  };
  struct Surroundings {
    ConeAxes axes;
    RelationExcerpts excerpts;
    std::size_t taken = 0;             // cones in excerpts
    std::optional<VesselField> whole;  // once they are more than there are

    Surroundings(const Known& known, const ContactQuestion& question)
        : axes(known.vessels.centerline), excerpts(axes, question, known.found.less_rounded) {}
  };
  struct Differences {
    std::vector<Index> old_cones;   // that the new vessels do not have
    std::vector<Index> new_cones;   // that the old vessels do not have
    std::vector<Index> new_number;  // of every old cone; kNone for those that the new vessels do not have
  };

  static Differences differences(const DividedCenterline& before, const DividedCenterline& after);
  std::size_t rounds_kept(std::size_t cones) const;
  Found find_all(const Centerline& vessels) const;
  Found updated(const Known& before, const DividedCenterline& after, const Differences& differences) const;
  bool find_around(const ConeAxes& axes, const ConeAxes& old_axes, const Differences& differences, Found& found,
                   std::vector<char>& is_seen) const;
  bool find_in(const ConeAxes& axes, const RelationExcerpt& part, bool is_whole_at_ends, Found& found,
               std::vector<char>& is_seen) const;

  ContactQuestion question_;
  bool at_all_;
  std::vector<std::optional<Known>> known_;             // by round
  std::size_t last_ = 0;                                // looked at
  mutable std::unique_ptr<Surroundings> surroundings_;  // of these, once they are needed
};

}  // namespace vmesh

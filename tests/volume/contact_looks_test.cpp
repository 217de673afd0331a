// Contacts found round by round, around what changed, are those found at once.
#include "volume/contact_looks.h"

#include <gtest/gtest.h>

#include "vmesh/volume/vessel_field.h"

#include "random_centerline.h"
#include "random_vessels.h"
#include "volume/moving.h"
#include "volume/narrowing.h"

namespace vmesh {
namespace {

using testing::CenterlineBuilder;
using testing::Draw;

// Crowded trees of random walks in steps from a fifth of a radius to several, and a sphere.
Centerline crowded_trees(Draw& draw) {
  CenterlineBuilder builder;
  for (int tree = 0; tree < 4; ++tree) {
    const auto first = static_cast<Index>(builder.nodes.size());
    builder.add(draw.in_cube(5), draw.uniform(0.3, 0.6));
    Vec3 way = draw.direction();
    const double shortest = draw.chance(0.5) ? 0.1 : 0.5;
    for (int i = 1; i < 60; ++i) {
      const auto count = static_cast<Index>(builder.nodes.size());
      const bool goes_on = draw.chance(0.9);
      const Index from = goes_on ? count - 1 : first + draw.below(count - first);
      way = goes_on ? Vec3((way + 0.4 * draw.direction()).normalized()) : draw.direction();
      builder.add(builder.nodes[from].position + draw.uniform(shortest, 2) * way,
                  builder.nodes[from].radius * draw.uniform(0.93, 1.02), from);
    }
  }
  builder.add(draw.in_cube(5), 0.5);
  return builder.build();
}

void expect_same(const std::vector<ContactPair>& found, const std::vector<ContactPair>& all) {
  ASSERT_EQ(found.size(), all.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    EXPECT_EQ(found[n].i, all[n].i);
    EXPECT_EQ(found[n].j, all[n].j);
    EXPECT_EQ(found[n].gap, all[n].gap);
    EXPECT_EQ(found[n].region, all[n].region);
    EXPECT_EQ(found[n].closest.excess, all[n].closest.excess);
    EXPECT_EQ(found[n].closest.s, all[n].closest.s);
    EXPECT_EQ(found[n].closest.t, all[n].closest.t);
  }
}

TEST(ContactLooks, FindWhatIsThere) {
  std::size_t pairs = 0, changes = 0;
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Draw draw(seed);
    const Centerline original = crowded_trees(draw);
    const double blend = seed % 4 == 0 ? 0 : seed % 4 == 1 ? 1.5 : 0.5, gap = seed % 3 == 0 ? 0.5 : 0.1;
    const ContactQuestion question{gap, blend};
    ContactLooks looks(question);
    Moving moving(original, 0.5);
    std::size_t last = 0;
    const auto compare = [&](const DividedCenterline& vessels, std::size_t round) {
      const ConeRelations relations(vessels.centerline, blend);
      const std::vector<ContactPair> all = find_contact_pairs(relations, gap);
      expect_same(looks.look(vessels, round), all);
      changes += all.size() != last;
      last = all.size();
      pairs += all.size();
    };
    const auto any_segment = [&](const Centerline& centerline) {
      return draw.below(static_cast<Index>(centerline.segments().size()));
    };
    for (int move = 0; move < 4 && !::testing::Test::HasFailure(); ++move) {
      const DividedCenterline moved = moving.apply();
      compare(moved, 0);
      Narrowing narrowing(moved.centerline, 0.25);
      for (std::size_t round = 1; round < 5; ++round) {
        for (int hold = 0; hold < 3; ++hold) {
          const Index s = any_segment(moved.centerline);
          narrowing.hold(s, draw.below(narrowing.leaf_count(s)), draw.uniform(0.3, 0.95));
        }
        compare(composed(moved, narrowing.apply()), round);
      }
      Moving::Shift shift;
      shift.direction = draw.direction();
      shift.distance = draw.uniform(0.2, 1.5);
      shift.stretches = {{any_segment(original), 0.2, 0.8, kNone}};
      if (draw.chance(0.2)) shift.stretches = {{kNone, 0, 0, static_cast<Index>(original.nodes().size() - 1)}};
      moving.add(shift);
    }
  }
  EXPECT_GT(pairs, 5'000u);
  EXPECT_GT(changes, 100u);
}

// As VesselField does for the whole.
TEST(ContactLooks, MeasureTheRoomBesideAVessel) {
  int limited = 0;
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Draw draw(seed);
    const Centerline centerline = crowded_trees(draw);
    ContactLooks looks({0.1, 0.5});
    looks.look(undivided(centerline), 0);
    const VesselField field(centerline, 0.5);
    for (int n = 0; n < 50; ++n) {
      const Index cone = draw.below(static_cast<Index>(field.relations().cone_count()));
      const Vec3 place = field.relations().axis_point(cone, 0.5) + draw.uniform(0, 2) * draw.direction();
      const double limit = draw.uniform(0.2, 3);
      EXPECT_EQ(looks.distance_to_others(place, cone, limit), field.distance_to_others(place, cone, limit));
      limited += looks.distance_to_others(place, cone, limit) < limit;
    }
  }
  EXPECT_GT(limited, 50);
}

}  // namespace
}  // namespace vmesh

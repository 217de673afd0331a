#include "vmesh/edit/crossing_guard.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "draw.h"

namespace vmesh {
namespace {

using testing::Draw;

// Small faces that fly about in a cube, appear and disappear; and what a guard over them should say.
class Flight {
 public:
  std::vector<std::optional<PlacedFace>> faces;
  const std::vector<CrossingGuard::AxisLine> axes{{Vec3(-5, -5, -5), Vec3(5, 5, 4)}, {Vec3(-5, 5, 0), Vec3(5, -4, 0)}};

  static PlacedFace random_face(Draw& draw, Index number) {
    const Vec3 middle = draw.in_cube(5);
    return {{3 * number, 3 * number + 1, 3 * number + 2},
            {middle + draw.in_cube(1.5), middle + draw.in_cube(1.5), middle + draw.in_cube(1.5)}};
  }

  bool may_replace(const PlacedFace& face, Index number) const {
    for (const auto& [from, to] : axes) {
      const std::optional<PlacedFace>& before = faces[number];
      if (meets_segment(face, from, to) && !(before && meets_segment(*before, from, to))) return false;
    }
    for (Index f = 0; f < faces.size(); ++f) {
      if (f != number && faces[f] && intersect(face, *faces[f])) return false;
    }
    return true;
  }
};

// So many changes, near and far, that the guard puts its boxes in order again several times.
TEST(CrossingGuard, AllowsExactlyWhatCrossesNothingHoweverMuchHasChanged) {
  Draw draw(67);
  Flight flight;
  flight.faces.resize(100);
  CrossingGuard guard(
      0, [&](Index f) { return f < flight.faces.size() ? flight.faces[f] : std::nullopt; }, flight.axes);
  int allowed = 0, refused = 0;
  for (int step = 0; step < 6000; ++step) {
    const Index f = draw.below(static_cast<Index>(flight.faces.size()));
    if (draw.chance(0.1)) {
      flight.faces[f].reset();
      guard.touch(f);
      continue;
    }
    const PlacedFace face = Flight::random_face(draw, f);
    const bool may = guard.allows({face}, {f});
    ASSERT_EQ(may, flight.may_replace(face, f)) << "step " << step;
    ++(may ? allowed : refused);
    if (!may) continue;
    flight.faces[f] = face;
    guard.touch(f);
  }
  EXPECT_GT(allowed, 500);
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace vmesh

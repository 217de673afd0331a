#include "surface/pieces/slow_pieces.h"

#include <gtest/gtest.h>

#include "centerlines.h"

namespace vmesh {
namespace {

PieceSurface piece_of(std::size_t vertices, double seconds) {
  PieceSurface piece;
  piece.work = {seconds, {}, vertices, 0, Vec3(1, 0, 0)};
  return piece;
}

TEST(SlowPieces, AreThoseOfMoreThanTenTimesTheMedian) {
  const Centerline tube = straight_tube();
  std::vector<PieceSurface> pieces = {piece_of(100, 1), piece_of(200, 2.2), piece_of(50, 4.9), piece_of(10, 1.2),
                                      piece_of(100, 30)};
  pieces[3].work.failed = {{DefectKind::crossing_faces, 4, 0.4}, {std::nullopt, 2, 0}, {std::nullopt, 0, 0.953}};
  std::vector<PiecePlan> plans(pieces.size());
  plans[3].nodes = {0, 1, 2};
  const std::vector<SlowPiece> slow = slow_pieces(pieces, plans, tube);
  // Times a vertex: .01, .011, .098, .12, .3; the median .098.
  ASSERT_TRUE(slow.empty());

  pieces[2].work.seconds = 0.5;  // the median is .011
  const std::vector<SlowPiece> two = slow_pieces(pieces, plans, tube);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_DOUBLE_EQ(two[0].seconds, 30);
  EXPECT_EQ(two[0].position, Vec3(1, 0, 0)) << "of a vertex, without nodes";
  EXPECT_EQ(two[0].reason, "made at the first try: 100 vertices, 0 junctions");
  EXPECT_NEAR(two[1].times, 0.12 / 0.011, 1e-9);
  EXPECT_EQ(two[1].vertices, 10U);
  EXPECT_EQ(two[1].position, Vec3(4, 0, 0)) << "the widest node";
  EXPECT_EQ(
      two[1].reason,
      "after tries that ended with 4 times crossing_faces, then a junction's surface hung between 2 vessels, then "
      "a triangle of skewness 0.953");
}

TEST(SlowPieces, OfNothingAreNone) { EXPECT_TRUE(slow_pieces({}, {}, straight_tube()).empty()); }

}  // namespace
}  // namespace vmesh

// With intermediate checks pieces are made as without, and what breaks an invariant is found.
#include "surface/pieces/piece_invariants.h"

#include <gtest/gtest.h>

#include "vmesh/core/execution.h"

#include "random_vessels.h"
#include "surface/paper/geodesic_sphere.h"

namespace vmesh {
namespace {

class WithChecks : public ::testing::Test {
 protected:
  ~WithChecks() override { execution_params().intermediate_checks = before_; }

  const bool before_ = std::exchange(execution_params().intermediate_checks, true);
};

class PieceInvariantsOf : public WithChecks, public ::testing::WithParamInterface<std::uint32_t> {};

TEST_P(PieceInvariantsOf, RandomVesselsHoldAndChangeNothing) {
  const Centerline centerline = testing::plausible_tree(GetParam(), static_cast<int>(GetParam() % 3));
  const GenerateResult checked = generate_surface(centerline, {});
  execution_params().intermediate_checks = false;
  const GenerateResult plain = generate_surface(centerline, {});
  EXPECT_EQ(checked.mesh.vertices, plain.mesh.vertices);
  EXPECT_EQ(checked.mesh.faces, plain.mesh.faces);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PieceInvariantsOf, ::testing::Range(std::uint32_t{40}, std::uint32_t{52}));

// A ball, and the piece that is to be it.
class Ball : public WithChecks {
 protected:
  Ball() { add_geodesic_sphere(surface_, Vec3::Zero(), 1, Eigen::Matrix3d::Identity(), 0); }

  PieceInvariants of(std::size_t filled_loops, const std::vector<PieceLoop>& loops) {
    PiecePlan plan;
    plan.nodes = {0};
    return {tubes_, plan, filled_loops, surface_, loops};
  }

  Centerline centerline_{{{{0, 0, 0}, 1}}, {}};
  VesselField field_{centerline_};
  VesselRings tubes_{field_, RingOptions::of({})};
  BoundSurface surface_{field_};
};

TEST_F(Ball, IsAsItsPlanSays) { EXPECT_NO_THROW(of(0, {}).check(surface_)); }

TEST_F(Ball, IsNoTorus) { EXPECT_THROW(of(1, {}).check(surface_), std::logic_error); }

TEST_F(Ball, MustBeClosed) {
  const PieceInvariants invariants = of(0, {});
  surface_.mesh.remove_face(Face(3));
  EXPECT_THROW(invariants.check(surface_), std::logic_error);
}

TEST_F(Ball, KeepsItsSeams) {
  surface_[Vertex(4)].role = BoundVertex::Role::held;
  const PieceInvariants invariants = of(0, {{kNone, {}, {Vertex(4)}}});
  EXPECT_NO_THROW(invariants.check(surface_));
  surface_.mesh.point(Vertex(4)) *= 1 + 1e-15;
  EXPECT_THROW(invariants.check(surface_), std::logic_error);
}

TEST_F(Ball, RefersToWhatItHas) {
  PieceSurface piece;
  piece.vertices = {Vec3::Zero(), Vec3::UnitX()};
  piece.binding.resize(2);
  piece.radius.resize(2);
  piece.seam_vertices.resize(1);
  piece.faces = {{0, 1, 2}};
  EXPECT_NO_THROW(check_numbers(piece));
  piece.faces = {{0, 1, 3}};
  EXPECT_THROW(check_numbers(piece), std::logic_error);
}

TEST_F(Ball, IsTheSameEachTime) {
  PieceSurface piece;
  piece.radius = {1};
  PieceSurface other = piece;
  EXPECT_NO_THROW(check_repeatable(piece, other));
  other.radius = {std::nextafter(1.0, 2)};
  EXPECT_THROW(check_repeatable(piece, other), std::logic_error);
}

TEST_F(Ball, ItsSeamsLieBetweenTwoPieces) {
  const Centerline line({{{0, 0, 0}, 1}, {{100, 0, 0}, 1}}, {{0, 1}});
  const VesselField field(line);
  const VesselRings tubes(field, RingOptions::of({}));
  Division division = divide(tubes, {});
  ASSERT_FALSE(division.seams.empty());
  const RingCounts rings(tubes);
  EXPECT_NO_THROW(check_division(rings, division));
  division.seams.pop_back();
  EXPECT_THROW(check_division(rings, division), std::logic_error);
}

}  // namespace
}  // namespace vmesh

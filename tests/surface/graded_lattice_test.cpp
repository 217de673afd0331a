#include "surface/junction/graded_lattice.h"

#include <map>

#include <gtest/gtest.h>

#include "draw.h"

namespace vmesh {
namespace {

using testing::Draw;

double volume(const GradedLattice& lattice, const GradedLattice::Tetrahedron& t) {
  const Vec3 a = lattice.position(t[0]);
  return (lattice.position(t[1]) - a).cross(lattice.position(t[2]) - a).dot(lattice.position(t[3]) - a) / 6;
}

double longest_edge(const GradedLattice& lattice, const GradedLattice::Tetrahedron& t) {
  double longest = 0;
  for (const Index a : t) {
    for (const Index b : t) longest = std::max(longest, (lattice.position(a) - lattice.position(b)).norm());
  }
  return longest;
}

std::vector<LatticeBall> random_balls(std::uint64_t seed) {
  Draw draw(static_cast<std::uint32_t>(seed));
  std::vector<LatticeBall> balls = {{Vec3::Zero(), 1, 1}};
  for (int i = 0; i < 6; ++i) {
    const double fine = std::pow(10, -draw.uniform(0, 2.5));
    balls.push_back({draw.in_cube(1), fine * draw.uniform(0.5, 3), fine});
  }
  return balls;
}

GradedLattice lattice_of(const std::vector<LatticeBall>& balls) {
  return {Vec3::Zero(), Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix(), 1, balls};
}

// Face to face: every face has one tetrahedron on each side, but where there are no more.
TEST(GradedLattice, FitsTogether) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const GradedLattice lattice = lattice_of(random_balls(seed));
    std::map<std::array<Index, 3>, int> faces;
    for (const auto& t : lattice.tetrahedra()) {
      EXPECT_GT(volume(lattice, t), 0);
      for (int i = 0; i < 4; ++i) {
        std::array<Index, 3> face;
        for (int j = 0, k = 0; j < 4; ++j) {
          if (j != i) face[k++] = t[j];
        }
        std::sort(face.begin(), face.end());
        ++faces[face];
      }
    }
    std::vector<char> at_border(lattice.size(), 0);
    for (const auto& [face, count] : faces) {
      EXPECT_TRUE(count == 1 || count == 2) << count << " tetrahedra at a face, seed " << seed;
      for (const Index p : face) at_border[p] = at_border[p] || count == 1;
    }
    for (Index p = 0; p < lattice.size(); ++p) EXPECT_EQ(lattice.at_border(p), at_border[p] != 0) << "point " << p;
  }
}

TEST(GradedLattice, IsFineWhereItIsAskedToBe) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<LatticeBall> balls = random_balls(seed);
    const GradedLattice lattice = lattice_of(balls);
    for (const auto& t : lattice.tetrahedra()) {
      for (const LatticeBall& ball : balls) {
        const bool reaches_in = std::any_of(
            t.begin(), t.end(), [&](Index p) { return (lattice.position(p) - ball.center).norm() < ball.radius; });
        EXPECT_TRUE(!reaches_in || longest_edge(lattice, t) <= ball.longest * (1 + 1e-12));  // rounding of positions
      }
    }
  }
}

// Three shapes below the unbisected one, whatever the depth: Maubach (1995).
TEST(GradedLattice, HasFewShapes) {
  const GradedLattice lattice = lattice_of(random_balls(7));
  std::map<long, int> shapes;  // by volume over the longest edge cubed
  for (const auto& t : lattice.tetrahedra())
    ++shapes[std::lround(1e6 * volume(lattice, t) / std::pow(longest_edge(lattice, t), 3))];
  EXPECT_LE(shapes.size(), 4u);
}

TEST(GradedLattice, KnowsWhatIsAroundAPoint) {
  const GradedLattice lattice = lattice_of(random_balls(3));
  std::vector<std::size_t> count(lattice.size(), 0);
  for (const auto& t : lattice.tetrahedra()) {
    for (const Index p : t) ++count[p];
  }
  for (Index p = 0; p < lattice.size(); ++p) {
    EXPECT_EQ(lattice.around(p).size(), count[p]);
    double longest = 0;
    for (const Index t : lattice.around(p)) longest = std::max(longest, longest_edge(lattice, lattice.tetrahedra()[t]));
    EXPECT_NEAR(lattice.spacing(p), longest, 1e-12);
  }
}

}  // namespace
}  // namespace vmesh

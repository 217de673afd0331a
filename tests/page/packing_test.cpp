// Numbers survive encoding in a page's text.
#include "page/packing.h"

#include <limits>

#include <gtest/gtest.h>

#include "unpack.h"

namespace vmesh::testing {
namespace {

using tool::grid_over;
using tool::on_grid;
using tool::pack;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

std::string base64_of(const std::string& text) {
  const std::vector<unsigned char> bytes(text.begin(), text.end());
  return tool::base64(bytes);
}

TEST(Base64, IsThatOfTheRfc) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foob"), "Zm9vYg==");
  EXPECT_EQ(base64_of("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of("\xff\xfe\xfd"), "//79");
}

TEST(Pack, BringsBackEveryNumber) {
  const std::vector<std::int64_t> numbers = {0,   -1,  1,      63,      64,      -64,         -65,          127,
                                             128, 300, -70000, 1 << 20, 1 << 28, (1LL << 40), -(1LL << 40), 5};
  for (const std::size_t stride : {1, 2, 3, 100}) EXPECT_EQ(unpack(pack(numbers, stride), stride), numbers) << stride;
  EXPECT_EQ(pack(std::vector<std::int64_t>{}), "");
}

TEST(Pack, TakesAByteForANeighbour) {
  std::vector<std::int64_t> numbers;
  for (std::int64_t i = 0; i < 300; ++i) numbers.push_back(1'000'000 + 60 * (i % 2));
  EXPECT_EQ(from_base64(pack(numbers)).size(), 299 + 3u);
}

TEST(PointGrid, KeepsPointsToHalfAStepOfTheLongestSide) {
  const std::vector<Vec3> points = {{-7, 2, 3}, {93, 2.5, -40}, {12.3456, 2.1234, 0.777}, {50, 2, 1}};
  const tool::PointGrid grid = grid_over(points);
  EXPECT_DOUBLE_EQ(grid.step, 100 / 65535.);
  EXPECT_EQ(grid.low, Vec3(-7, 2, -40));
  const std::vector<std::int64_t> places = on_grid(points, grid);
  ASSERT_EQ(places.size(), 12u);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const int axis = static_cast<int>(i % 3);
    const double back = grid.low[axis] + grid.step * static_cast<double>(places[i]);
    EXPECT_LE(std::abs(back - points[i / 3][axis]), 0.5000001 * grid.step);
    EXPECT_GE(places[i], 0);
    EXPECT_LE(places[i], 65535);
  }
}

TEST(PointGrid, LeavesOutWhatIsNotFinite) {
  const std::vector<Vec3> points = {{1, 1, 1}, {kNan, 0, 0}, {0, kInfinity, 0}, {3, 1, 1}};
  const tool::PointGrid grid = grid_over(points);
  EXPECT_EQ(grid.low, Vec3(1, 1, 1));
  EXPECT_EQ(on_grid(points, grid), (std::vector<std::int64_t>{0, 0, 0, 0, 0, 0, 0, 0, 0, 65535, 0, 0}));
}

TEST(PointGrid, HoldsNoPointsAndOnePoint) {
  EXPECT_EQ(grid_over(std::vector<Vec3>{}).step, 1);
  const std::vector<Vec3> one = {{5, 6, 7}};
  EXPECT_EQ(on_grid(one, grid_over(one)), (std::vector<std::int64_t>{0, 0, 0}));
}

TEST(ValueGrid, KeepsValuesToHalfAStepAndSaysWhereThereIsNone) {
  const std::vector<double> values = {0.25, -1.5, kNan, 3.75, 0.333};
  const tool::ValueGrid grid = grid_over(values, false);
  EXPECT_DOUBLE_EQ(grid.low, -1.5);
  EXPECT_DOUBLE_EQ(grid.step, 5.25 / 4095);
  const std::vector<std::int64_t> places = on_grid(values, grid);
  EXPECT_EQ(places[2], tool::kNoValue);
  for (const std::size_t i : {0, 1, 3, 4})
    EXPECT_LE(std::abs(grid.low + grid.step * static_cast<double>(places[i]) - values[i]), 0.5000001 * grid.step);
}

TEST(ValueGrid, LabelsAreThemselves) {
  const std::vector<double> labels = {7, 0, -1, 123456};
  EXPECT_EQ(on_grid(labels, grid_over(labels, true)), (std::vector<std::int64_t>{7, 0, -1, 123456}));
}

TEST(ValueGrid, EqualValuesHaveAGridToo) {
  const std::vector<double> same = {2.5, 2.5};
  const tool::ValueGrid grid = grid_over(same, false);
  EXPECT_EQ(on_grid(same, grid), (std::vector<std::int64_t>{0, 0}));
  EXPECT_EQ(grid.low, 2.5);
  EXPECT_EQ(on_grid(std::vector<double>{kNan}, grid_over(std::vector<double>{kNan}, false))[0], tool::kNoValue);
}

}  // namespace
}  // namespace vmesh::testing

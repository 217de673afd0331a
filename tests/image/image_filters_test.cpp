#include "vmesh/image/image_filters.h"

#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

/// Values along x + 10 y + 100 z in voxels.
VoxelImage ramp(std::size_t ni, std::size_t nj, std::size_t nk) {
  VoxelImage image;
  image.size = {ni, nj, nk};
  for (std::size_t k = 0; k < nk; ++k)
    for (std::size_t j = 0; j < nj; ++j)
      for (std::size_t i = 0; i < ni; ++i) image.values.push_back(static_cast<float>(i + 10 * j + 100 * k));
  image.origin = Vec3(1, 2, 3);
  image.steps = Eigen::Vector3d(0.5, 1, 2).asDiagonal();
  return image;
}

TEST(BinaryMask, HoldsBothLimits) {
  const VoxelImage mask = binary_mask(ramp(5, 1, 1), 1, 3);
  EXPECT_EQ(mask.values, (std::vector<float>{0, 1, 1, 1, 0}));
}

TEST(Cropped, KeepsPlaceAndValues) {
  const VoxelImage image = ramp(6, 5, 4), part = cropped(image, {1, 2, 1}, {4, 3, 3});
  EXPECT_EQ(part.size, (std::array<std::size_t, 3>{4, 2, 3}));
  EXPECT_EQ(part.at(0, 0, 0), image.at(1, 2, 1));
  EXPECT_EQ(part.at(3, 1, 2), image.at(4, 3, 3));
  EXPECT_EQ(part.position(Vec3(3, 1, 2)), image.position(Vec3(4, 3, 3)));
}

TEST(CroppedTo, LeavesTheMarginWhereThereIsOne) {
  VoxelImage image = ramp(20, 20, 20);
  image.values.assign(image.values.size(), 0);
  image.values[image.offset(10, 1, 19)] = 1;
  const VoxelImage part = cropped_to(image, 0.5, 2);  // 4, 2 and 1 voxels
  EXPECT_EQ(part.size, (std::array<std::size_t, 3>{9, 4, 2}));
  EXPECT_EQ(part.at(4, 1, 1), 1);
  EXPECT_EQ(part.position(Vec3(4, 1, 1)), image.position(Vec3(10, 1, 19)));
  EXPECT_THROW(cropped_to(image, 2, 2), InvalidInput);
}

TEST(Resampled, KeepsLinearValuesAndTheMiddle) {
  const VoxelImage image = ramp(13, 9, 5), fine = resampled(image, 0.4);
  EXPECT_LT((fine.spacing() - Vec3::Constant(0.4)).norm(), 1e-12);
  const auto middle = [](const VoxelImage& of) {
    return of.position(0.5 * Vec3(static_cast<double>(of.size[0] - 1), static_cast<double>(of.size[1] - 1),
                                  static_cast<double>(of.size[2] - 1)));
  };
  EXPECT_LT((middle(fine) - middle(image)).norm(), 1e-9);
  for (std::size_t k = 3; k + 3 < fine.size[2]; ++k) {
    for (std::size_t j = 2; j + 2 < fine.size[1]; ++j) {
      for (std::size_t i = 1; i + 1 < fine.size[0]; ++i) {
        const Vec3 p = fine.position(Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)));
        const Vec3 voxel = image.steps.inverse() * (p - image.origin);
        // Values are of the order of 400 in float.
        ASSERT_NEAR(fine.at(i, j, k), voxel.dot(Vec3(1, 10, 100)), 1e-3);
      }
    }
  }
}

TEST(Resampled, RefusesWhatItCannotHold) {
  EXPECT_THROW(resampled(ramp(3, 3, 3), 0), InvalidInput);
  EXPECT_THROW(resampled(ramp(3, 3, 3), -1), InvalidInput);
  EXPECT_THROW(resampled(ramp(3, 3, 3), std::nan("")), InvalidInput);
  EXPECT_THROW(resampled(ramp(3, 3, 3), 1e-5), InvalidInput);
}

TEST(Smoothed, SpreadsAPointAsItsWidthSays) {
  VoxelImage image = ramp(41, 31, 21);
  image.values.assign(image.values.size(), 0);
  image.values[image.offset(20, 15, 10)] = 1;
  const double sigma = 1.8;
  const VoxelImage wide = smoothed(image, sigma);
  double sum = 0;
  Vec3 mean = Vec3::Zero(), square = Vec3::Zero();
  for (std::size_t k = 0; k < image.size[2]; ++k) {
    for (std::size_t j = 0; j < image.size[1]; ++j) {
      for (std::size_t i = 0; i < image.size[0]; ++i) {
        const Vec3 p = image.position(Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)));
        const Vec3 d = p - image.position(Vec3(20, 15, 10));
        sum += wide.at(i, j, k);
        mean += wide.at(i, j, k) * d;
        square += wide.at(i, j, k) * d.cwiseProduct(d);
      }
    }
  }
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_LT(mean.norm(), 1e-5);
  // What is cut off beyond 3 sigma takes 2.7 % off the variance.
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(std::sqrt(square[a]), sigma, 0.03 * sigma);
}

TEST(Smoothed, LeavesAConstantAlone) {
  VoxelImage image = ramp(4, 3, 2);
  image.values.assign(image.values.size(), 5);
  for (const float value : smoothed(image, 30).values) EXPECT_NEAR(value, 5, 1e-4);
  EXPECT_THROW(smoothed(image, 0), InvalidInput);
}

}  // namespace
}  // namespace vmesh

#include "vmesh/image/image_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

#include "../io/io_support.h"
#include "image_files.h"

namespace vmesh::testing {
namespace {

LoadedImage image_of(const std::array<std::size_t, 3>& size, std::vector<float> values) {
  LoadedImage loaded;
  loaded.image.size = size;
  loaded.image.values = std::move(values);
  loaded.image.steps = Vec3(0.5, 1, 2).asDiagonal();
  return loaded;
}

/// Components of voxels of equal values that touch, by flooding; by value.
std::map<float, std::uint64_t> flooded(VoxelImage image) {
  std::map<float, std::uint64_t> counts;
  const auto size = [&](int a) { return static_cast<std::ptrdiff_t>(image.size[a]); };
  for (std::size_t start = 0; start < image.values.size(); ++start) {
    const float value = image.values[start];
    if (value == 0) continue;
    ++counts[value];
    image.values[start] = 0;
    for (std::vector<std::size_t> reached = {start}; !reached.empty();) {
      const auto voxel = static_cast<std::ptrdiff_t>(reached.back());
      reached.pop_back();
      const std::ptrdiff_t i = voxel % size(0), j = voxel / size(0) % size(1), k = voxel / (size(0) * size(1));
      for (std::ptrdiff_t n = 0; n < 27; ++n) {
        const std::ptrdiff_t x = i + n % 3 - 1, y = j + n / 3 % 3 - 1, z = k + n / 9 - 1;
        if (x < 0 || y < 0 || z < 0 || x >= size(0) || y >= size(1) || z >= size(2)) continue;
        const std::size_t other = image.offset(x, y, z);
        if (image.values[other] != value) continue;
        image.values[other] = 0;
        reached.push_back(other);
      }
    }
  }
  return counts;
}

TEST(ImageSummary, ComponentsAreThoseFoundByFlooding) {
  std::mt19937 random(3);
  const std::array<std::size_t, 3> sizes[] = {{12, 11, 10}, {1, 20, 20}, {20, 1, 20}, {20, 20, 1}, {1, 1, 50}};
  for (const auto& size : sizes) {
    for (const int fill : {3, 10, 30, 60, 90}) {
      for (const int labels : {1, 2, 5}) {
        std::vector<float> values(size[0] * size[1] * size[2]);
        for (float& value : values)
          value = static_cast<int>(random() % 100) < fill ? static_cast<float>(1 + random() % labels) : 0.0f;
        const LoadedImage image = image_of(size, values);
        const ImageSummary summary = summarize_image(image);
        const std::map<float, std::uint64_t> expected = flooded(image.image);
        EXPECT_FALSE(summary.grey);
        ASSERT_EQ(summary.labels.size(), expected.size());
        std::uint64_t voxels = summary.zeros;
        for (const ImageLabel& label : summary.labels) {
          EXPECT_EQ(label.components, expected.at(label.value)) << fill << " % of " << labels;
          EXPECT_EQ(label.voxels, std::ranges::count(values, label.value));
          EXPECT_EQ(label.volume_mm3, static_cast<double>(label.voxels));
          voxels += label.voxels;
        }
        EXPECT_EQ(voxels, summary.voxels());
      }
    }
  }
}

TEST(ImageSummary, ComponentsTouchAtCornersAndAcrossSlices) {
  // A diagonal through space, and two voxels with one between them.
  std::vector<float> values(27);
  values[0] = values[13] = values[26] = 4;
  values[2] = values[20] = -1;
  const ImageSummary summary = summarize_image(image_of({3, 3, 3}, values));
  ASSERT_EQ(summary.labels.size(), 2u);
  EXPECT_EQ(summary.labels[0].value, -1);
  EXPECT_EQ(summary.labels[0].components, 2u);
  EXPECT_EQ(summary.labels[1].value, 4);
  EXPECT_EQ(summary.labels[1].components, 1u);
  EXPECT_EQ(summary.labels[1].voxels, 3u);
}

TEST(ImageSummary, ALoopThatClosesInTheLastSliceIsOneComponent) {
  std::vector<float> values(3 * 5 * 4);
  for (std::size_t k = 0; k < 4; ++k) values[k * 15] = values[k * 15 + 12] = 1;
  EXPECT_EQ(summarize_image(image_of({3, 5, 4}, values)).labels.at(0).components, 2u);
  for (std::size_t j = 0; j < 5; ++j) values[45 + 3 * j] = 1;
  EXPECT_EQ(summarize_image(image_of({3, 5, 4}, values)).labels.at(0).components, 1u);
}

TEST(ImageSummary, MoreThan64ValuesOrFractionsAreGrey) {
  std::vector<float> values(65);
  for (std::size_t v = 0; v < values.size(); ++v) values[v] = static_cast<float>(v);
  const ImageSummary labels = summarize_image(image_of({5, 13, 1}, values));
  EXPECT_EQ(labels.labels.size(), 64u);
  EXPECT_FALSE(labels.grey);
  values.resize(130, 65.0f);
  const ImageSummary grey = summarize_image(image_of({5, 13, 2}, values));
  EXPECT_TRUE(grey.labels.empty());
  ASSERT_TRUE(grey.grey);
  EXPECT_EQ(grey.zeros, 1u);
  EXPECT_EQ(grey.grey->least, 0);
  EXPECT_EQ(grey.grey->greatest, 65);
  EXPECT_DOUBLE_EQ(grey.grey->mean, (64 * 65 / 2 + 65 * 65) / 130.0);
  EXPECT_TRUE(summarize_image(image_of({2, 2, 1}, {0, 1, 0.5f, 1})).grey);
  EXPECT_TRUE(summarize_image(image_of({2, 1, 1}, {std::numeric_limits<float>::quiet_NaN(), 1})).grey);
}

TEST(ImageSummary, PercentilesAreThoseOfSortedValues) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal(20, 500);
  for (const bool whole : {true, false}) {
    std::vector<float> values(30 * 30 * 30);
    for (float& value : values) value = whole ? std::round(normal(random)) : 1e-3f * normal(random);
    const ImageSummary summary = summarize_image(image_of({30, 30, 30}, values));
    std::ranges::sort(values);
    ASSERT_TRUE(summary.grey);
    EXPECT_EQ(summary.grey->least, values.front());
    EXPECT_EQ(summary.grey->greatest, values.back());
    for (const Percentile& percentile : summary.grey->percentiles) {
      const auto rank = static_cast<std::size_t>(std::ceil(percentile.percent / 100 * 27000)) - 1;
      const float expected = values[rank];
      EXPECT_NEAR(percentile.value, expected, whole ? 0 : std::abs(expected) / 32768) << percentile.percent;
    }
  }
}

TEST(ImageSummary, OfAFileTellsItsFrameAndVolumes) {
  const TemporaryFolder folder;
  const SampleImage sample;
  std::vector<double> values(static_cast<std::size_t>(sample.count()));
  values[100] = values[101] = values[209] = 3;
  const auto path = folder.write("a.nii.gz", packed(nifti_file<std::uint8_t>(sample, values), true));
  std::vector<double> fractions;
  const ImageSummary summary = summarize_image(path, [&](std::string_view, double fraction) {
    fractions.push_back(fraction);
    return true;
  });
  EXPECT_EQ(fractions.size(), 5u);
  EXPECT_TRUE(summary.image.integer);
  EXPECT_LT((summary.image.frame.position(Vec3(6, 5, 4)) - sample.position(6, 5, 4)).norm(), 1e-5);
  EXPECT_EQ(summary.voxels(), 210u);
  EXPECT_EQ(summary.zeros, 207u);
  ASSERT_EQ(summary.labels.size(), 1u);
  EXPECT_EQ(summary.labels[0].components, 2u);
  EXPECT_NEAR(summary.labels[0].volume_mm3, 3 * 0.75 * 1.25 * 2.5, 1e-4);
  EXPECT_THROW(summarize_image(path, [](std::string_view, double) { return false; }), Cancelled);
  EXPECT_THROW(summarize_image(folder / "missing.nii"), ReadError);
}

TEST(ImageSummary, OfZerosHasNoLabel) {
  const ImageSummary summary = summarize_image(image_of({3, 3, 3}, std::vector<float>(27)));
  EXPECT_TRUE(summary.labels.empty());
  EXPECT_FALSE(summary.grey);
  EXPECT_EQ(summary.zeros, 27u);
}

}  // namespace
}  // namespace vmesh::testing

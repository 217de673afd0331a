#include "vmesh/image/image_slices.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/image/image_io.h"

#include "../io/io_support.h"
#include "image_files.h"

namespace vmesh::testing {
namespace {

/// What a reader of slices calls, in order.
struct Record {
  std::vector<ImageFrame> begins;
  std::vector<float> values;
  std::size_t slices = 0;

  ImageBegin begin() {
    return [this](const ImageFrame& image) { begins.push_back(image); };
  }
  SliceVisitor visit() {
    return [this](std::size_t k, std::span<const float> slice) {
      ASSERT_EQ(begins.size(), 1u);
      EXPECT_EQ(k, slices++);
      EXPECT_EQ(slice.size(), begins[0].frame.size[0] * begins[0].frame.size[1]);
      values.insert(values.end(), slice.begin(), slice.end());
    };
  }
};

class ImageSlices : public ::testing::Test {
 protected:
  static Record parsed(const std::string& name, const std::string& content) {
    Record record;
    parse_image_slices(content, name, record.begin(), record.visit());
    return record;
  }

  void expect_is_sample(const Record& record) const {
    ASSERT_EQ(record.begins.size(), 1u);
    const ImageFrame& image = record.begins[0];
    EXPECT_TRUE(image.integer);
    EXPECT_TRUE(image.frame.values.empty());
    EXPECT_LT((image.frame.position(Vec3(6, 5, 4)) - sample_.position(6, 5, 4)).norm(), 1e-5);
    EXPECT_EQ(record.slices, 5u);
    EXPECT_EQ(record.values, std::vector<float>(values_.begin(), values_.end()));
  }

  const TemporaryFolder folder_;
  const SampleImage sample_;
  const std::vector<double> values_ = sample_.values();
  const std::string voxels_ = voxel_bytes<std::int16_t>(values_);
  const std::string nifti_ = nifti_file<std::int16_t>(sample_, values_);
};

TEST_F(ImageSlices, ComeInOrderFromEveryFormat) {
  const std::string gzip = "encoding: gzip\n", zlib = "CompressedData = True\n";
  const std::pair<const char*, std::string> files[] = {
      {"a.nii", nifti_},
      {"b.nii.gz", packed(nifti_, true)},
      {"c.nrrd", nrrd_header(sample_, "short") + voxels_},
      {"d.nrrd", nrrd_header(sample_, "short", gzip) + packed(voxels_, true)},
      {"e.mha", mha_header(sample_, "MET_SHORT") + voxels_},
      {"f.MHA", mha_header(sample_, "MET_SHORT", zlib) + packed(voxels_, false)}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    expect_is_sample(parsed(name, content));
    Record of_file;
    read_image_slices(folder_.write(name, content), of_file.begin(), of_file.visit());
    expect_is_sample(of_file);
  }
}

TEST_F(ImageSlices, OfAnImageInMemoryAreTheSame) {
  const LoadedImage loaded = parse_image(nifti_, "a.nii");
  Record record;
  record.begin()({loaded.image, loaded.integer, {}});
  visit_slices(loaded.image, record.visit());
  EXPECT_EQ(record.slices, 5u);
  EXPECT_EQ(record.values, loaded.image.values);
}

TEST_F(ImageSlices, AreSmallerOrLargerThanABlock) {
  for (const std::array<int, 3>& size : {std::array{1, 1, 150000}, {150000, 1, 1}, {333, 333, 2}}) {
    SampleImage image;
    image.size = size;
    std::vector<double> values;
    for (int v = 0; v < image.count(); ++v) values.push_back(v % 30011);
    const std::string bytes = voxel_bytes<std::int16_t>(values);
    const Record record = parsed("a.nrrd", nrrd_header(image, "short", "encoding: gzip\n") + packed(bytes, true));
    EXPECT_EQ(record.slices, static_cast<std::size_t>(size[2]));
    EXPECT_EQ(record.values, std::vector<float>(values.begin(), values.end()));
    EXPECT_EQ(parsed("a.mha", mha_header(image, "MET_SHORT") + bytes).values, record.values);
  }
}

TEST_F(ImageSlices, VoxelsMayBeginFarBehindTheHeader) {
  std::string file = nifti_;
  file.replace(108, 4, bytes_of(200000.0f, false)).insert(352, std::string(200000 - 352, 'x'));
  expect_is_sample(parsed("a.nii", file));
  expect_is_sample(parsed("a.nii.gz", packed(file, true)));
  EXPECT_THROW(parsed("a.nii", file.substr(0, 150000)), InvalidInput);
  EXPECT_THROW(parsed("a.nii.gz", packed(file.substr(0, 150000), true)), InvalidInput);
}

TEST_F(ImageSlices, WhatTheSizeOfTheFileTellsIsToldBeforeTheBeginning) {
  Record record;
  const auto path = folder_.write("a.nii", nifti_.substr(0, nifti_.size() - 1));
  const std::string message =
      message_of<InvalidInput>([&] { read_image_slices(path, record.begin(), record.visit()); });
  expect_contains(message, "the header claims 210 voxels, 420 bytes, but the file holds 419");
  EXPECT_TRUE(record.begins.empty());
}

TEST_F(ImageSlices, ACompressedFileThatEndsEarlyIsToldWhereItEnds) {
  Record record;
  const std::string half = nifti_.substr(0, 352 + 211);
  const std::string message = message_of<InvalidInput>(
      [&] { parse_image_slices(packed(half, true), "a.nii.gz", record.begin(), record.visit()); });
  expect_contains(message, "the header claims 210 voxels, 420 bytes, but the file holds 211");
  EXPECT_EQ(record.begins.size(), 1u);
}

TEST_F(ImageSlices, AVoxelThatIsNotFiniteIsCountedInTheWholeImage) {
  SampleImage image;
  image.size = {100, 100, 10};
  std::vector<double> values(100000, 1.0);
  values[77777] = std::numeric_limits<double>::quiet_NaN();
  const std::string file = nrrd_header(image, "float") + voxel_bytes<float>(values);
  Record record;
  const std::string message =
      message_of<InvalidInput>([&] { parse_image_slices(file, "a.nrrd", record.begin(), record.visit()); });
  expect_contains(message, "voxel 77777");
  EXPECT_LE(record.slices, 7u);
}

TEST_F(ImageSlices, WhatAVisitorThrowsIsPassedOn) {
  std::size_t visited = 0;
  const auto visit = [&](std::size_t k, std::span<const float>) {
    ++visited;
    if (k == 2) throw std::domain_error("enough");
  };
  EXPECT_THROW(parse_image_slices(
                   packed(nifti_, true), "a.nii.gz", [](const ImageFrame&) {}, visit),
               std::domain_error);
  EXPECT_EQ(visited, 3u);
}

TEST_F(ImageSlices, WhatIsNoImageIsRefused) {
  Record record;
  const auto read = [&](const std::filesystem::path& path) { read_image_slices(path, record.begin(), record.visit()); };
  EXPECT_THROW(read(folder_ / "missing.nii"), ReadError);
  EXPECT_THROW(read(folder_ / "."), ReadError);
  EXPECT_THROW(read(folder_.write("empty.nrrd", "")), InvalidInput);
  EXPECT_THROW(read(folder_.write("a.png", "x")), Unsupported);
  EXPECT_THROW(read(folder_.write("plain.nii.gz", nifti_)), InvalidInput);
  EXPECT_TRUE(record.begins.empty());
}

}  // namespace
}  // namespace vmesh::testing

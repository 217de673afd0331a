#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "vmesh/image/contour.h"
#include "vmesh/image/image_io.h"

#include "../io/io_support.h"
#include "dicom_bytes.h"

namespace vmesh::testing {
namespace {

class Dicom : public ::testing::Test {
 protected:
  /// Slices under names that do not follow their order.
  void write_series(const std::vector<double>& values, const DicomTags& tags = {},
                    const std::string& name = "IM") const {
    std::vector<int> number(image_.size[2]);
    for (int k = 0; k < image_.size[2]; ++k) number[k] = k;
    std::mt19937 random(7);
    std::shuffle(number.begin(), number.end(), random);
    for (int k = 0; k < image_.size[2]; ++k)
      folder_.write(name + std::to_string(number[k]), dicom_slice(image_, values, k, tags));
  }

  VoxelImage as_nifti(const std::vector<double>& values) const {
    return parse_image(nifti_file<std::int16_t>(image_, values), "a.nii").image;
  }

  std::filesystem::path folder() const { return folder_ / ""; }

  static void expect_same(const VoxelImage& a, const VoxelImage& b) {
    EXPECT_EQ(a.size, b.size);
    EXPECT_LT((a.origin - b.origin).norm(), 1e-4);  // NIfTI headers hold float
    EXPECT_LT((a.steps - b.steps).norm(), 1e-6);
    EXPECT_EQ(a.values, b.values);
  }

  TemporaryFolder folder_;
  SampleImage image_ = scan_place();
};

TEST_F(Dicom, ASeriesLiesWhereTheSameVolumeAsNiftiLies) {
  for (const double handed : {1.0, -1.0}) {
    image_.direction.col(1) = handed * SampleImage::oblique().col(1);
    image_.direction.col(2) = image_.direction.col(0).cross(image_.direction.col(1));
    const std::vector<double> values = scan_of_vessels(image_);
    write_series(values);
    const LoadedImage loaded = read_image(folder());
    expect_same(loaded.image, as_nifti(values));
    EXPECT_TRUE(loaded.integer);
    EXPECT_TRUE(loaded.warnings.empty());
    expect_same(read_image(folder_ / "IM3").image, loaded.image);
  }
}

TEST_F(Dicom, SlicesStoredFromTheTopLieUpright) {
  // Third axis against the normal: the same volume, counted from the other end.
  SampleImage top = image_;
  top.origin = image_.position(0, 0, image_.size[2] - 1);
  top.direction.col(2) *= -1;
  const std::vector<double> values = scan_of_vessels(image_);
  const std::ptrdiff_t area = static_cast<std::ptrdiff_t>(image_.size[0]) * image_.size[1];
  std::vector<double> from_top;
  for (int k = image_.size[2] - 1; k >= 0; --k)
    from_top.insert(from_top.end(), values.begin() + k * area, values.begin() + (k + 1) * area);
  for (int k = 0; k < top.size[2]; ++k) folder_.write("IM" + std::to_string(k), dicom_slice(top, from_top, k));
  expect_same(read_image(folder()).image, as_nifti(values));
}

TEST_F(Dicom, ItsContourIsThatOfTheSameVolumeAsNifti) {
  const std::vector<double> values = scan_of_vessels(image_);
  write_series(values);
  const TriMesh dicom = contour(read_image(folder()).image, 200), nifti = contour(as_nifti(values), 200);
  ASSERT_EQ(dicom.vertices.size(), nifti.vertices.size());
  for (std::size_t v = 0; v < dicom.vertices.size(); ++v)
    EXPECT_LT((dicom.vertices[v] - nifti.vertices[v]).norm(), 1e-4);
}

TEST_F(Dicom, ValuesAreRescaled) {
  const SampleImage image;
  std::vector<double> values = image.values();
  DicomTags tags;
  tags.slope = 0.5;
  tags.intercept = 10;
  for (const char* modality : {"CT", "MR"}) {
    tags.modality = modality;
    for (int k = 0; k < image.size[2]; ++k)
      folder_.write("IM" + std::to_string(k), dicom_slice(image, values, k, tags));
    const LoadedImage loaded = read_image(folder());
    EXPECT_FALSE(loaded.integer);
    for (std::size_t v = 0; v < values.size(); ++v) EXPECT_EQ(loaded.image.values[v], values[v]);
  }
}

TEST_F(Dicom, ATiltedGantryShearsTheGrid) {
  const std::vector<double> values = image_.values();
  SampleImage tilted = image_;
  tilted.direction.col(2) = (tilted.direction.col(2) + 0.3 * tilted.direction.col(1)).eval();
  for (int k = 0; k < tilted.size[2]; ++k) folder_.write("IM" + std::to_string(k), dicom_slice(tilted, values, k));
  const VoxelImage read = read_image(folder()).image;
  EXPECT_LT((read.position(Vec3(5, 6, 30)) - tilted.position(5, 6, 30)).norm(), 1e-5);
}

TEST_F(Dicom, SeveralSeriesAreListedAndOneIsChosenByAFileOfIt) {
  const std::vector<double> values = scan_of_vessels(image_), mask = scan_of_vessels(image_, true, false);
  write_series(values, {.series = "1.2.3.5", .description = "Arterial 1.0"}, "A");
  write_series(mask, {.series = "1.2.3.6", .description = "mask"}, "B");
  const std::string message = message_of<InvalidInput>([&] { read_image(folder()); });
  for (const char* part : {"2 DICOM series", "give a file", "\n  CT \"Arterial 1.0\", 36 slices of 48 x 40: ", "/A0",
                           "CT \"mask\", 36 slices", "/B0"})
    expect_contains(message, part);
  expect_same(read_image(folder_ / "A1").image, as_nifti(values));
  expect_same(read_image(folder_ / "B1").image, as_nifti(mask));
}

TEST_F(Dicom, WhatIsNoRegularStackIsRefused) {
  const std::vector<double> values = image_.values();
  const auto refusal = [&] { return message_of<InvalidInput>([&] { read_image(folder()); }); };
  write_series(values);
  const std::filesystem::path inside = folder_ / "IM99";

  SampleImage other = image_;
  other.origin += 4.5 * image_.spacing.z() * image_.direction.col(2);
  folder_.write("IM99", dicom_slice(other, values, 0));
  expect_contains(refusal(), "not evenly spaced");
  other.origin = image_.origin;
  folder_.write("IM99", dicom_slice(other, values, 0));
  expect_contains(refusal(), "lie where another one does");
  other.direction.col(0) = image_.direction.col(1);
  other.direction.col(1) = image_.direction.col(2);
  folder_.write("IM99", dicom_slice(other, values, 0));
  expect_contains(refusal(), "rotated relative to the first");
  other = image_;
  other.size = {40, 48, 36};
  folder_.write("IM99", dicom_slice(other, values, 0));
  expect_contains(refusal(), "size or spacing");
  std::filesystem::remove(inside);
  EXPECT_NO_THROW(read_image(folder()));
}

TEST_F(Dicom, MissingSlicesAreNoticed) {
  const std::vector<double> values = image_.values();
  for (int k = 0; k < image_.size[2]; ++k)
    if (k != 20 && k != 21) folder_.write("IM" + std::to_string(k), dicom_slice(image_, values, k));
  const std::string message = message_of<InvalidInput>([&] { read_image(folder()); });
  for (const char* part : {"slices are missing", "3.75 mm", "IM19", "IM22", "1.25 mm"}) expect_contains(message, part);
}

TEST_F(Dicom, OneSliceIsNoVolume) {
  folder_.write("IM0", dicom_slice(image_, image_.values(), 0));
  expect_contains(message_of<InvalidInput>([&] { read_image(folder()); }), "only one slice");
}

TEST_F(Dicom, WhatIsNoImageIsLeftOut) {
  const std::vector<double> values = scan_of_vessels(image_);
  const std::string report = "1.2.840.10008.5.1.4.1.1.88.11";
  write_series(values);
  folder_.write("SR", dicom_file(report, "1.2.9", element(8, 0x16, "UI", report) + element(8, 0x60, "CS", "SR")));
  folder_.write("notes.txt", "not DICOM");
  expect_same(read_image(folder()).image, as_nifti(values));
  expect_contains(message_of<InvalidInput>([&] { read_image(folder_ / "SR"); }), "contains no image");
  expect_contains(message_of<InvalidInput>([&] { read_image(folder_.write("a.dcm", "x")); }), "not a DICOM file");
}

TEST_F(Dicom, FramesOfOneFileAreSortedAndRescaledEachByItself) {
  const SampleImage image;
  std::vector<double> values = image.values();
  for (double& value : values) value *= 2;
  const LoadedImage loaded = read_image(folder_.write("a.dcm", dicom_frames(image, values, {3, 0, 4, 2, 1})));
  for (std::size_t v = 0; v < values.size(); ++v) EXPECT_EQ(loaded.image.values[v], values[v]);
  EXPECT_LT((loaded.image.position(Vec3(6, 5, 4)) - image.position(6, 5, 4)).norm(), 1e-5);
}

TEST_F(Dicom, SegmentsThatOverlapAreToldOf) {
  const std::vector<double> ones(static_cast<std::size_t>(image_.count()), 1);
  std::string bytes = dicom_segmentation(image_, ones, {{1, 0}, {1, 0}});
  // The second frame becomes one of segment 2, in the place of the first.
  const std::string number = short_element(0x62, 0xb, 1);
  bytes.replace(bytes.rfind(number), number.size(), short_element(0x62, 0xb, 2));
  const LoadedImage loaded = read_image(folder_.write("seg.dcm", bytes));
  ASSERT_EQ(loaded.warnings.size(), 1u);
  expect_contains(loaded.warnings[0], "several segments");
  EXPECT_EQ(loaded.image.size[2], 1u);
  EXPECT_EQ(loaded.image.values[0], 2);
}

TEST_F(Dicom, ASegmentationIsLabels) {
  std::vector<double> labels = scan_of_vessels(image_, true, false), other = scan_of_vessels(image_, false, true);
  for (std::size_t v = 0; v < labels.size(); ++v) labels[v] = labels[v] >= 200 ? 1 : other[v] >= 200 ? 2 : 0;
  // Frames without anything in them are left out, as is usual; layers at both ends may be.
  const auto frames_of = [&](std::initializer_list<int> segments) {
    std::vector<SegmentFrame> frames;
    const std::size_t area = static_cast<std::size_t>(image_.size[0]) * image_.size[1];
    for (const int segment : segments)
      for (int k = 0; k < image_.size[2]; ++k)
        if (std::find(labels.begin() + k * area, labels.begin() + (k + 1) * area, segment) !=
            labels.begin() + (k + 1) * area)
          frames.push_back({segment, k});
    return frames;
  };
  for (const auto& segments : {std::initializer_list<int>{1}, {1, 2}}) {
    const std::vector<SegmentFrame> frames = frames_of(segments);
    const LoadedImage loaded = read_image(folder_.write("seg.dcm", dicom_segmentation(image_, labels, frames)));
    EXPECT_TRUE(loaded.integer);
    const int first = std::min_element(frames.begin(), frames.end(), [](auto a, auto b) { return a.k < b.k; })->k;
    const VoxelImage& read = loaded.image;
    EXPECT_LT((read.origin - image_.position(0, 0, first)).norm(), 1e-5);
    std::size_t wrong = 0;
    for (std::size_t k = 0; k < read.size[2]; ++k)
      for (std::size_t j = 0; j < read.size[1]; ++j)
        for (std::size_t i = 0; i < read.size[0]; ++i) {
          const double label = labels[((k + first) * image_.size[1] + j) * image_.size[0] + i];
          wrong += read.at(i, j, k) != (label > static_cast<double>(segments.size()) ? 0 : label) ? 1 : 0;
        }
    EXPECT_EQ(wrong, 0u);
  }
}

TEST_F(Dicom, WhatIsCutOffOrDamagedIsAnError) {
  SampleImage image;
  const std::vector<double> values = image.values();
  for (int k = 0; k < image.size[2]; ++k) folder_.write("IM" + std::to_string(k), dicom_slice(image, values, k));
  const std::string whole = content_of(folder_ / "IM2"), seg = dicom_segmentation(image, values, {{1, 0}, {1, 1}});
  for (std::size_t size = 0; size < whole.size(); size += size < 700 ? 5 : 23) {
    folder_.write("IM2", whole.substr(0, size));
    EXPECT_THROW(read_image(folder()), InvalidInput)
        << size;  // even if it is no longer a DICOM file: then one is missing
  }
  std::filesystem::remove_all(folder());
  std::filesystem::create_directory(folder());
  for (std::size_t size = 0; size < seg.size(); size += 37)
    EXPECT_THROW(read_image(folder_.write("seg.dcm", seg.substr(0, size))), InvalidInput) << size;
}

TEST_F(Dicom, BytesThatAreWrongNeverCrash) {
  SampleImage image;
  const std::vector<double> values = image.values();
  for (int k = 0; k < image.size[2]; ++k) folder_.write("IM" + std::to_string(k), dicom_slice(image, values, k));
  const std::string whole = content_of(folder_ / "IM2");
  std::mt19937 random(3);
  for (int round = 0; round < 60; ++round) {
    std::string bytes = whole;
    for (int n = 0; n < 3; ++n) bytes[132 + random() % 500] = static_cast<char>(random());
    folder_.write("IM2", bytes);
    try {
      read_image(folder());
    } catch (const Error&) {
    }
  }
}

}  // namespace
}  // namespace vmesh::testing

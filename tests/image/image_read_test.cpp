#include <limits>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/image/image_io.h"

#include "../io/io_support.h"
#include "image_files.h"

namespace vmesh::testing {
namespace {

class ReadImage : public ::testing::Test {
 protected:
  static LoadedImage read(const std::string& name, const std::string& content) { return parse_image(content, name); }
  template <class Expected>
  static std::string refusal(const std::string& name, const std::string& content) {
    const std::string message = message_of<Expected>([&] { read(name, content); });
    expect_contains(message, name);
    return message;
  }

  TemporaryFolder folder_;
  SampleImage sample_;
};

/// Positions in NIfTI headers are float: 1e-5 mm at coordinates of up to 50 mm.
void expect_is(const LoadedImage& loaded, const SampleImage& sample) {
  for (int a = 0; a < 3; ++a) ASSERT_EQ(loaded.image.size[a], static_cast<std::size_t>(sample.size[a]));
  ASSERT_EQ(loaded.image.values.size(), static_cast<std::size_t>(sample.count()));
  for (int k = 0; k < sample.size[2]; ++k) {
    for (int j = 0; j < sample.size[1]; ++j) {
      for (int i = 0; i < sample.size[0]; ++i) {
        ASSERT_EQ(loaded.image.at(i, j, k), sample.value(i, j, k)) << i << " " << j << " " << k;
        ASSERT_LT((loaded.image.position(Vec3(i, j, k)) - sample.position(i, j, k)).norm(), 1e-5)
            << loaded.image.position(Vec3(i, j, k)).transpose() << " instead of "
            << sample.position(i, j, k).transpose();
      }
    }
  }
}

TEST_F(ReadImage, AnObliqueImageLiesAtOnePlaceInEveryFormat) {
  const std::vector<double> values = sample_.values();
  expect_is(read("s.nii", nifti_file<std::int16_t>(sample_, values)), sample_);
  expect_is(read("q.nii", nifti_file<std::int16_t>(sample_, values, NiftiPlace::qform)), sample_);
  const std::string voxels = voxel_bytes<std::int16_t>(values);
  expect_is(read("lps.nrrd", nrrd_header(sample_, "short") + voxels), sample_);
  expect_is(read("ras.nrrd", nrrd_header(sample_, "short", "encoding: raw\n", true) + voxels), sample_);
  expect_is(read("a.mha", mha_header(sample_, "MET_SHORT") + voxels), sample_);
}

TEST_F(ReadImage, ReadsNifti2) {
  const std::vector<double> values = sample_.values();
  expect_is(read("s.nii", nifti2_file<std::int16_t>(sample_, values)), sample_);
  expect_is(read("big.nii", nifti2_file<float>(sample_, values, true)), sample_);
  expect_is(read("d.nii.gz", packed(nifti2_file<double>(sample_, values), true)), sample_);
  std::string complex_numbers = nifti2_file<float>(sample_, values);
  complex_numbers[12] = 32;
  expect_contains(refusal<Unsupported>("c.nii", complex_numbers), "NIfTI data type 32 is not supported");
}

TEST_F(ReadImage, AFileIsReadAsItsBytesAre) {
  const std::string bytes = nifti_file<std::int16_t>(sample_, sample_.values());
  expect_is(read_image(folder_.write("a.NII", bytes)), sample_);
  expect_is(read_image(folder_.write("b.nii.gz", packed(bytes, true))), sample_);
}

TEST_F(ReadImage, ScaledNiftiValuesAreScaled) {
  std::string bytes = nifti_file<std::int16_t>(sample_, sample_.values());
  bytes.replace(112, 4, bytes_of(0.5f, false)).replace(116, 4, bytes_of(-7.0f, false));
  const LoadedImage loaded = read("a.nii", bytes);
  EXPECT_EQ(loaded.image.at(3, 2, 1), 0.5 * SampleImage::value(3, 2, 1) - 7);
  EXPECT_FALSE(loaded.integer);
}

TEST_F(ReadImage, ASkewedSformGivesWayToAQform) {
  std::string bytes = nifti_file<std::int16_t>(sample_, sample_.values(), NiftiPlace::qform);
  bytes.replace(254, 2, bytes_of(std::int16_t{1}, false));
  const float rows[12] = {1, 0.5f, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  for (int i = 0; i < 12; ++i) bytes.replace(280 + 4 * i, 4, bytes_of(rows[i], false));
  expect_is(read("a.nii", bytes), sample_);
}

TEST_F(ReadImage, NiftiWithoutAPlaceIsWarnedOf) {
  std::string bytes = nifti_file<std::int16_t>(sample_, sample_.values());
  bytes.replace(254, 2, bytes_of(std::int16_t{0}, false));
  const LoadedImage loaded = read("a.nii", bytes);
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_EQ(loaded.image.position(Vec3(1, 1, 1)), Vec3(0.75, 1.25, 2.5));
}

TEST_F(ReadImage, AMirroredImageLiesAtOnePlaceInEveryFormat) {
  sample_.direction.col(0) *= -1;
  const std::vector<double> values = sample_.values();
  expect_is(read("s.nii", nifti_file<std::int16_t>(sample_, values)), sample_);
  expect_is(read("q.nii", nifti_file<std::int16_t>(sample_, values, NiftiPlace::qform)), sample_);
  const std::string voxels = voxel_bytes<std::int16_t>(values);
  expect_is(read("a.nrrd", nrrd_header(sample_, "short") + voxels), sample_);
  expect_is(read("a.mha", mha_header(sample_, "MET_SHORT") + voxels), sample_);
}

TEST_F(ReadImage, PackedFilesHoldTheSame) {
  const std::vector<double> values = sample_.values();
  const std::string voxels = voxel_bytes<std::int16_t>(values);
  expect_is(read("a.nii.gz", packed(nifti_file<std::int16_t>(sample_, values), true)), sample_);
  expect_is(read("a.nrrd", nrrd_header(sample_, "short", "encoding: gzip\n") + packed(voxels, true)), sample_);
  const std::string data = packed(voxels, false);
  const std::string more = "CompressedData = True\nCompressedDataSize = " + std::to_string(data.size()) + "\n";
  expect_is(read("a.mha", mha_header(sample_, "MET_SHORT", more) + data), sample_);
}

TEST_F(ReadImage, NumbersOfAnyKindAndByteOrder) {
  const std::vector<double> values = sample_.values();
  expect_is(read("be16.nii", nifti_file<std::int16_t>(sample_, values, NiftiPlace::sform, true)), sample_);
  expect_is(read("f.nii", nifti_file<float>(sample_, values)), sample_);
  expect_is(read("bef.nii.gz", packed(nifti_file<float>(sample_, values, NiftiPlace::qform, true), true)), sample_);
  expect_is(read("d.nii", nifti_file<double>(sample_, values)), sample_);
  expect_is(read("i.nrrd", nrrd_header(sample_, "int") + voxel_bytes<std::int32_t>(values)), sample_);
  expect_is(read("i.mha", mha_header(sample_, "MET_INT") + voxel_bytes<std::int32_t>(values)), sample_);
  expect_is(read("f.mha", mha_header(sample_, "MET_FLOAT") + voxel_bytes<float>(values)), sample_);
  EXPECT_FALSE(read("f.nii", nifti_file<float>(sample_, values)).integer);
  EXPECT_TRUE(read("s.nii", nifti_file<std::int16_t>(sample_, values)).integer);
}

TEST_F(ReadImage, BytesAreUnsigned) {
  const std::vector<double> values(static_cast<std::size_t>(sample_.count()), 200.0);
  EXPECT_EQ(read("u.nii", nifti_file<std::uint8_t>(sample_, values)).image.at(3, 2, 1), 200);
  EXPECT_EQ(read("u.nrrd", nrrd_header(sample_, "uchar") + voxel_bytes<std::uint8_t>(values)).image.at(3, 2, 1), 200);
  EXPECT_EQ(read("u.mha", mha_header(sample_, "MET_UCHAR") + voxel_bytes<std::uint8_t>(values)).image.at(3, 2, 1), 200);
}

TEST_F(ReadImage, NumbersThatAreNotFiniteAreRefused) {
  std::vector<double> values = sample_.values();
  values[11] = std::numeric_limits<double>::quiet_NaN();
  expect_contains(refusal<InvalidInput>("nan.nii", nifti_file<float>(sample_, values)), "voxel 11");
  values[11] = std::numeric_limits<double>::infinity();
  expect_contains(refusal<InvalidInput>("inf.nrrd", nrrd_header(sample_, "float") + voxel_bytes<float>(values)),
                  "voxel 11");
}

TEST_F(ReadImage, LabelsTooLargeToTellApartAreRefused) {
  std::vector<double> values = sample_.values();
  values[5] = 16777217;
  expect_contains(refusal<Unsupported>("big.nrrd", nrrd_header(sample_, "int") + voxel_bytes<std::int32_t>(values)),
                  "16777217");
}

TEST_F(ReadImage, IncompleteFilesAreRefusedWhereverTheyEnd) {
  const std::vector<double> values = sample_.values();
  const std::string voxels = voxel_bytes<std::int16_t>(values), data = packed(voxels, false);
  const std::string more = "CompressedData = True\nCompressedDataSize = " + std::to_string(data.size()) + "\n";
  const std::pair<const char*, std::string> files[] = {
      {"a.nii", nifti_file<std::int16_t>(sample_, values)},
      {"a.nii.gz", packed(nifti_file<std::int16_t>(sample_, values), true)},
      {"a.nrrd", nrrd_header(sample_, "short") + voxels},
      {"z.nrrd", nrrd_header(sample_, "short", "encoding: gzip\n") + packed(voxels, true)},
      {"a.mha", mha_header(sample_, "MET_SHORT") + voxels},
      {"z.mha", mha_header(sample_, "MET_SHORT", more) + data},
  };
  for (const auto& [name, content] : files) {
    for (const std::size_t left : {std::size_t{1}, std::size_t{10}, content.size() / 4, content.size() / 2,
                                   content.size() - 40, content.size() - 2 - 8 * 2}) {
      SCOPED_TRACE(std::string(name) + " cut to " + std::to_string(left) + " of " + std::to_string(content.size()));
      refusal<InvalidInput>(name, content.substr(0, left));
    }
  }
}

TEST_F(ReadImage, HeadersThatClaimMoreThanTheFileHoldsAreRefusedBeforeAllocation) {
  const std::vector<double> values = sample_.values();
  const std::string voxels = voxel_bytes<std::int16_t>(values);
  SampleImage liar = sample_;
  liar.size = {30000, 30000, 30000};
  const std::string nifti = nifti_file<std::int16_t>(liar, values);
  expect_contains(refusal<InvalidInput>("a.nii", nifti), "27000000000000 voxels");
  expect_contains(refusal<InvalidInput>("a.nii.gz", packed(nifti, true)), "27000000000000 voxels");
  expect_contains(refusal<InvalidInput>("a.nrrd", nrrd_header(liar, "short") + voxels), "27000000000000 voxels");
  expect_contains(
      refusal<InvalidInput>("z.nrrd", nrrd_header(liar, "short", "encoding: gzip\n") + packed(voxels, true)),
      "27000000000000 voxels");
  expect_contains(refusal<InvalidInput>("a.mha", mha_header(liar, "MET_SHORT") + voxels), "27000000000000 voxels");
  expect_contains(
      refusal<InvalidInput>("z.mha", mha_header(liar, "MET_SHORT", "CompressedData = True\n") + packed(voxels, false)),
      "27000000000000 voxels");
  liar.size = {2000000000, 2000000000, 2000000000};
  refusal<InvalidInput>("b.nrrd", nrrd_header(liar, "short") + voxels);
  refusal<InvalidInput>("b.mha", mha_header(liar, "MET_SHORT") + voxels);
}

TEST_F(ReadImage, AxesWithoutVolumeAreRefused) {
  sample_.direction.col(2) = sample_.direction.col(1);
  const std::string voxels = voxel_bytes<std::int16_t>(sample_.values());
  refusal<InvalidInput>("flat.nrrd", nrrd_header(sample_, "short") + voxels);
  refusal<InvalidInput>("flat.mha", mha_header(sample_, "MET_SHORT") + voxels);
}

const std::vector<int> kPortalAndHepatic = {0, 1, 1, 0, 2, 2, 0, 1, 1, 0, 2, 2},
                       kTumor = {0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 1, 0};

std::vector<float> read_segments(const ImageReadOptions& choice, const std::string& more = "") {
  const LoadedImage loaded = parse_image(layered_nrrd(kPortalAndHepatic, kTumor, more), "s.seg.nrrd", choice);
  EXPECT_EQ(loaded.image.size, (std::array<std::size_t, 3>{3, 2, 2}));
  EXPECT_EQ(loaded.image.position(Vec3(0, 0, 1)), Vec3(5, 6, 9));
  return loaded.image.values;
}

TEST_F(ReadImage, SegmentsThatOverlapAreReadByNameOrValue) {
  const auto where = [](const std::vector<int>& layer, int value) {
    std::vector<float> values;
    for (const int there : layer) values.push_back(static_cast<float>(there == value ? value : 0));
    return values;
  };
  EXPECT_EQ(read_segments({{"portal"}, {}}), where(kPortalAndHepatic, 1));
  EXPECT_EQ(read_segments({{"Hepatic Vein"}, {}}), where(kPortalAndHepatic, 2));
  EXPECT_EQ(read_segments({{}, {2}}), where(kPortalAndHepatic, 2));
  EXPECT_EQ(read_segments({{"tumor"}, {}}), where(kTumor, 1));
  EXPECT_EQ(values_of({"TUMOR", "hepatic vein"},
                      parse_image(layered_nrrd(kPortalAndHepatic, kTumor), "s.seg.nrrd", {{"tumor"}, {}}).segments),
            (std::vector<double>{1, 2}));
}

TEST_F(ReadImage, SegmentsThatAreNotClearAreRefusedWithTheirNames) {
  const auto error = [](const ImageReadOptions& choice, const std::string& more = "") {
    return message_of<InvalidInput>([&] { read_segments(choice, more); });
  };
  expect_contains(error({}),
                  "s.seg.nrrd: its segments overlap, in 2 layers; choose by name or value, with --label: the "
                  "segments are \"Portal\" (1), \"hepatic vein\" (2) and \"tumor\" (1)");
  expect_contains(error({{"artery"}, {}}), "\"Portal\" (1)");
  expect_contains(error({{}, {1}}), "several segments have the value chosen; choose by name");
  expect_contains(error({{}, {2}}, "Segment2_Layer:=2\n"), "the segment \"tumor\" is in layer 2; there are 2");
  expect_contains(error({{}, {2}}, "Segment2_Layer:=-1\n"), "segment 2: its Layer is negative");
  expect_contains(error({{}, {2}}, "Segment0_LabelValue:=x\n"), "LabelValue");
  expect_contains(message_of<InvalidInput>([] { values_of({"a"}, {}); }), "the image names no segments");
  EXPECT_EQ(read("flat.nrrd", nrrd_header(sample_, "short", "encoding: raw\nSegment7_Name:=vessel\n") +
                                  voxel_bytes<std::int16_t>(sample_.values()))
                .segments.at(0)
                .name,
            "vessel");
  std::string many = layered_nrrd(kPortalAndHepatic, kTumor);
  refusal<InvalidInput>("many.nrrd", many.replace(many.find("sizes: 2"), 8, "sizes: 99999999999"));
}

TEST_F(ReadImage, WhatIsNoScalarImageOfThreeDimensionsIsRefused) {
  const std::string voxels = voxel_bytes<std::int16_t>(sample_.values());
  std::string flat = nifti_file<std::int16_t>(sample_, sample_.values());
  flat[40] = 2;
  refusal<InvalidInput>("two.nii", flat);
  refusal<Unsupported>("vector.mha",
                       mha_header(sample_, "MET_SHORT", "ElementNumberOfChannels = 3\n") + voxels + voxels + voxels);
  refusal<Unsupported>("apart.nrrd", nrrd_header(sample_, "short", "encoding: raw\ndata file: other.raw\n") + voxels);
  std::string apart = mha_header(sample_, "MET_SHORT");
  apart.replace(apart.find("LOCAL"), 5, "x.raw");
  refusal<Unsupported>("apart.mha", apart + voxels);
}

TEST_F(ReadImage, WhatIsNoImageIsRefused) {
  for (const char* name : {"a.nii", "a.nii.gz", "a.nrrd", "a.mha"}) {
    EXPECT_THROW(read_image(folder_.write(name, "")), InvalidInput);
    refusal<InvalidInput>(name, "hello world\n");
    refusal<InvalidInput>(name, std::string(5000, '\0'));
    EXPECT_THROW(read_image(folder_ / ("missing_" + std::string(name))), ReadError);
  }
  refusal<Unsupported>("a.png", "hello");
  refusal<InvalidInput>("plain.nii.gz", nifti_file<std::int16_t>(sample_, sample_.values()));
  EXPECT_THROW(read_image(folder_ / "."), ReadError);
}

TEST_F(ReadImage, BrokenHeadersEndInAnErrorNotACrash) {
  const std::vector<double> values = sample_.values();
  const std::string voxels = voxel_bytes<std::int16_t>(values);
  const std::pair<const char*, std::string> files[] = {
      {"a.nii", nifti_file<std::int16_t>(sample_, values)},
      {"a.nrrd", nrrd_header(sample_, "short") + voxels},
      {"a.mha", mha_header(sample_, "MET_SHORT") + voxels},
  };
  for (const auto& [name, content] : files) {
    const std::size_t header = content.size() - voxels.size();
    for (std::size_t at = 0; at < header; ++at) {
      for (const char byte : {'\xff', '9', '\0'}) {
        std::string broken = content;
        broken[at] = byte;
        try {
          parse_image(broken, name);
        } catch (const Error&) {
        }
      }
    }
  }
  std::string many = mha_header(sample_, "MET_SHORT") + voxels;
  many.replace(many.find("NDims = 3"), 9, "NDims = 99");
  EXPECT_THROW(read("many.mha", many), Error);
}

}  // namespace
}  // namespace vmesh::testing

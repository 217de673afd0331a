#include <gtest/gtest.h>
#include <tiffio.h>

#include "vmesh/core/error.h"
#include "vmesh/image/image_io.h"

#include "../io/io_support.h"
#include "image_files.h"

namespace vmesh::testing {
namespace {

const std::string kImageJ = "ImageJ=1.53t\nimages=5\nslices=5\nunit=micron\nspacing=2.0\nloop=false\n";

class ReadTiff : public ::testing::Test {
 protected:
  static LoadedImage read(const std::string& content, const ImageReadOptions& options = {}) {
    return parse_image(content, "s.tif", options);
  }
  template <class Expected = InvalidInput>
  static std::string refusal(const std::string& content) {
    const std::string message = message_of<Expected>([&] { read(content); });
    expect_contains(message, "s.tif: ");
    return message;
  }

  /// The sample written by libtiff, with these settings of its fields.
  std::filesystem::path write(const std::string& name, int compression, bool tiled) const {
    const std::filesystem::path path = folder_ / name;
    TIFF* tiff = TIFFOpen(path.c_str(), "w");
    for (int k = 0; k < sample_.size[2]; ++k) {
      TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, sample_.size[0]);
      TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, sample_.size[1]);
      TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
      TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_INT);
      TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
      TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
      TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
      const int side = tiled ? 16 : 0;
      tiled ? TIFFSetField(tiff, TIFFTAG_TILEWIDTH, side) : TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 4);
      if (tiled) TIFFSetField(tiff, TIFFTAG_TILELENGTH, side);
      write_page(tiff, k, side);
      TIFFWriteDirectory(tiff);
    }
    TIFFClose(tiff);
    return path;
  }

  void write_page(TIFF* tiff, int k, int side) const {
    const int wide = side > 0 ? side : sample_.size[0], high = side > 0 ? side : sample_.size[1];
    std::vector<std::int16_t> voxels(static_cast<std::size_t>(wide * high), 99);
    for (int j = 0; j < sample_.size[1]; ++j)
      for (int i = 0; i < sample_.size[0]; ++i)
        voxels[static_cast<std::size_t>(j * wide + i)] = static_cast<std::int16_t>(sample_.value(i, j, k));
    if (side > 0) {
      TIFFWriteTile(tiff, voxels.data(), 0, 0, 0, 0);
    } else {
      for (int j = 0; j < high; ++j) TIFFWriteScanline(tiff, voxels.data() + j * wide, static_cast<std::uint32_t>(j));
    }
  }

  TemporaryFolder folder_;
  SampleImage sample_;
};

void expect_values(const LoadedImage& loaded, const SampleImage& sample) {
  for (int a = 0; a < 3; ++a) ASSERT_EQ(loaded.image.size[a], static_cast<std::size_t>(sample.size[a]));
  const std::vector<double> expected = sample.values();
  ASSERT_EQ(loaded.image.values.size(), expected.size());
  for (std::size_t v = 0; v < expected.size(); ++v) ASSERT_EQ(loaded.image.values[v], expected[v]) << v;
}

TEST_F(ReadTiff, NumbersOfEveryKindAndByteOrder) {
  std::vector<double> values = sample_.values();
  EXPECT_TRUE(read(tiff_file<std::int16_t>(sample_, values)).integer);
  EXPECT_FALSE(read(tiff_file<float>(sample_, values)).integer);
  expect_values(read(tiff_file<std::int16_t>(sample_, values)), sample_);
  expect_values(read(tiff_file<std::int32_t>(sample_, values)), sample_);
  expect_values(read(tiff_file<float>(sample_, values)), sample_);
  expect_values(read(tiff_file<double>(sample_, values)), sample_);
  expect_values(read(tiff_file<std::int16_t>(sample_, values, "", 0, true)), sample_);
  for (double& value : values) value = static_cast<int>(value + 3) % 100;
  const std::vector<float> expected(values.begin(), values.end());
  EXPECT_EQ(read(tiff_file<std::uint8_t>(sample_, values)).image.values, expected);
  EXPECT_EQ(read(tiff_file<std::int8_t>(sample_, values)).image.values, expected);
  EXPECT_EQ(read(tiff_file<std::uint16_t>(sample_, values)).image.values, expected);
  EXPECT_EQ(read(tiff_file<std::uint32_t>(sample_, values, "", 0, true)).image.values, expected);
  values[7] = 1 << 30;
  values[8] = (1 << 30) + 1;
  expect_contains(refusal<Unsupported>(tiff_file<std::int32_t>(sample_, values)), "cannot be told apart");
}

TEST_F(ReadTiff, CompressedAndTiledFilesHoldTheSame) {
  for (const bool tiled : {false, true}) {
    for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS}) {
      const auto path = write("s" + std::to_string(compression) + (tiled ? "t.TIFF" : ".tif"), compression, tiled);
      expect_values(read_image(path), sample_);
      expect_values(read(content_of(path)), sample_);
    }
  }
}

TEST_F(ReadTiff, VoxelsAreAsLargeAsImageJSays) {
  const std::vector<double> values = sample_.values();
  const auto position = [&](const std::string& description, double resolution, const ImageReadOptions& options = {}) {
    const LoadedImage loaded = read(tiff_file<std::int16_t>(sample_, values, description, resolution), options);
    return loaded.image.position(Vec3(1, 2, 3));
  };
  EXPECT_TRUE(position(kImageJ, 4).isApprox(Vec3(0.00025, 0.0005, 0.006)));
  std::string millimetres = kImageJ;
  millimetres.replace(millimetres.find("micron"), 6, "mm");
  EXPECT_TRUE(position(millimetres, 4).isApprox(Vec3(0.25, 0.5, 6)));
  EXPECT_TRUE(position("ImageJ=1.53t\nimages=5\nunit=\\u00B5m\n", 1).isApprox(Vec3(0.001, 0.002, 0.003)));
  ImageReadOptions options;
  options.voxel_size = Vec3(2, 3, 4);
  EXPECT_EQ(position("", 0, options), Vec3(2, 6, 12));
  EXPECT_EQ(position(millimetres, 4, options), Vec3(2, 6, 12));
  const auto warnings = [&](const std::string& description, double resolution, const ImageReadOptions& with = {}) {
    return read(tiff_file<std::int16_t>(sample_, values, description, resolution), with).warnings;
  };
  EXPECT_EQ(warnings(millimetres, 4).size(), 1u);  // of the frame
  for (const std::string description : {"", "ImageJ=1.53t\nimages=5\nunit=pixel\n", "made by hand\nunit=mm\n"})
    expect_contains(warnings(description, 4).front(), "1 mm is assumed (set it with --voxel-size)");
  expect_contains(warnings(millimetres, 0).front(), "1 mm is assumed");
  expect_contains(warnings(millimetres, 4, options).front(), "the file says another size of voxels");
}

TEST_F(ReadTiff, WhatIsNoStackOfNumbersIsRefused) {
  const std::vector<double> values = sample_.values();
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = kImageJ;
    return tiff_file<std::int16_t>(sample_, values, text.replace(text.find(from), from.size(), to), 4);
  };
  expect_contains(refusal<Unsupported>(with("slices=5", "channels=2")), "has \"2\" channels");
  expect_contains(refusal<Unsupported>(with("images=5", "images=600")), "ImageJ stored \"600\" slices in 5 pages");
  expect_contains(refusal<Unsupported>(with("slices=5", "frames=3")), "has \"3\" frames");
  const std::string good = tiff_file<std::int16_t>(sample_, values);
  const auto entry = [&](int tag) { return good.find(bytes_of(static_cast<std::uint16_t>(tag), false) + "\3"); };
  const auto changed = [&](int tag, std::uint16_t value) {
    std::string file = good;
    return file.replace(entry(tag) + 8, 2, bytes_of(value, false));
  };
  expect_contains(refusal<Unsupported>(changed(277, 3)), "has 3 numbers per voxel");
  expect_contains(refusal<Unsupported>(changed(258, 4)), "4 bits");
  refusal("II*");
  refusal("hello world");
  refusal(good.substr(0, 40));
  std::string smaller = good;  // the second page
  smaller.replace(
      good.find(bytes_of(std::uint16_t{256}, false) + "\4", good.find(bytes_of(std::uint16_t{256}, false) + "\4") + 1) +
          8,
      4, bytes_of(std::uint32_t{3}, false));
  expect_contains(refusal(smaller), "page 1: its size or type is not that of the first page");
}

TEST_F(ReadTiff, ClaimsBeyondTheFileAreRefusedBeforeAllocation) {
  std::string huge = tiff_file<std::int16_t>(sample_, sample_.values());
  const std::size_t width = huge.find(bytes_of(std::uint16_t{256}, false) + "\4");
  huge.replace(width + 8, 4, bytes_of(std::uint32_t{2'000'000'000}, false));
  expect_contains(refusal(huge), "more than the file can hold");
  const auto path = write("t.tif", COMPRESSION_ADOBE_DEFLATE, true);
  const std::string whole = content_of(path);
  for (std::size_t size = 0; size + 1 < whole.size(); size += 7) {
    SCOPED_TRACE(size);
    refusal(whole.substr(0, size));
  }
  EXPECT_THROW(read_image(folder_ / "missing.tif"), ReadError);
}

}  // namespace
}  // namespace vmesh::testing

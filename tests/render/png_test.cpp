#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <png.h>

#include "vmesh/core/error.h"
#include "vmesh/render/image.h"

namespace vmesh {
namespace {

namespace fs = std::filesystem;

class WritePng : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              ("vmesh_png_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    image_ = {3, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {1, 2, 3}, {10, 20, 30}, {100, 150, 200}}};
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  static std::string bytes_of(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  fs::path folder_;
  Image image_;
};

TEST_F(WritePng, WritesWhatLibpngReadsBack) {
  const fs::path path = folder_ / "a.png";
  write_png(path, image_);
  EXPECT_EQ(files(), 1u);
  png_image header;
  std::memset(&header, 0, sizeof header);
  header.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&header, path.c_str()));
  ASSERT_EQ(header.width, 3u);
  ASSERT_EQ(header.height, 2u);
  header.format = PNG_FORMAT_RGB;
  std::vector<Color> pixels(6);
  ASSERT_TRUE(png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr));
  EXPECT_EQ(pixels, image_.pixels);
}

TEST_F(WritePng, ReplacesAnOlderFileAndKeepsItsBytesTheSame) {
  const fs::path path = folder_ / "a.png";
  std::ofstream(path) << "old";
  write_png(path, image_);
  const auto first = bytes_of(path);
  EXPECT_EQ(first.substr(1, 3), "PNG");
  write_png(path, image_);
  EXPECT_EQ(bytes_of(path), first);
  EXPECT_EQ(files(), 1u);
}

TEST_F(WritePng, LeavesNothingBehindWhenItFails) {
  EXPECT_THROW(write_png(folder_ / "missing" / "a.png", image_), WriteError);
  EXPECT_THROW(write_png(folder_, image_), WriteError);
  EXPECT_EQ(files(), 0u);
  EXPECT_THROW(write_png("/dev/full", image_), WriteError);
}

TEST_F(WritePng, NamesTheFileInItsMessage) {
  try {
    write_png(folder_ / "missing" / "a.png", image_);
    FAIL();
  } catch (const WriteError& error) {
    EXPECT_NE(std::string(error.what()).find("a.png"), std::string::npos);
  }
}

TEST_F(WritePng, RejectsImagesThatAreNone) {
  EXPECT_THROW(write_png(folder_ / "a.png", {}), InvalidInput);
  EXPECT_THROW(write_png(folder_ / "a.png", {2, 2, {Color{}}}), InvalidInput);
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace vmesh

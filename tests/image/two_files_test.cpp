// Images with header and voxels in two files.
#include <random>

#include <gtest/gtest.h>

#include "vmesh/image/image_io.h"

#include "../io/io_support.h"
#include "image_files.h"

namespace vmesh::testing {
namespace {

class TwoFiles : public ::testing::Test {
 protected:
  static std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  }

  std::filesystem::path write_mhd(const std::string& voxels) const {
    folder_.write("a.raw", voxels);
    return folder_.write("a.mhd", replaced(mha_header(image_, "MET_SHORT"), "LOCAL", "a.raw"));
  }
  std::filesystem::path write_nhdr(const std::string& voxels) const {
    folder_.write("b.raw", voxels);
    return folder_.write("b.nhdr", nrrd_header(image_, "short", "encoding: raw\ndata file: b.raw\n"));
  }
  std::filesystem::path write_pair(const std::string& voxels) const {
    std::string bytes = nifti_file<std::int16_t>(image_, values_).substr(0, 352);
    bytes.replace(344, 4, std::string("ni1\0", 4));
    bytes.replace(108, 4, bytes_of(0.0f, false));
    folder_.write("c.img", voxels);
    return folder_.write("c.hdr", bytes);
  }

  void expect_is_sample(const std::filesystem::path& path) const {
    const LoadedImage loaded = read_image(path);
    EXPECT_TRUE(loaded.integer) << path;
    EXPECT_TRUE(loaded.warnings.empty()) << path;
    ASSERT_EQ(loaded.image.values.size(), values_.size()) << path;
    for (std::size_t v = 0; v < values_.size(); ++v) EXPECT_EQ(loaded.image.values[v], values_[v]);
    EXPECT_LT((loaded.image.position(Vec3(6, 5, 4)) - image_.position(6, 5, 4)).norm(), 1e-4) << path;
    EXPECT_LT((loaded.image.origin - image_.origin).norm(), 1e-4) << path;
  }

  const TemporaryFolder folder_;
  const SampleImage image_;
  const std::vector<double> values_ = image_.values();
  const std::string voxels_ = voxel_bytes<std::int16_t>(values_);
};

TEST_F(TwoFiles, LieWhereTheSameVolumeInOneFileLies) {
  expect_is_sample(write_mhd(voxels_));
  expect_is_sample(write_nhdr(voxels_));
  expect_is_sample(write_pair(voxels_));
  expect_is_sample(folder_ / "c.img");
}

TEST_F(TwoFiles, AnalyzeWarnsThatItHasNoFrame) {
  write_pair(voxels_);
  std::string header = content_of(folder_ / "c.hdr");
  header.replace(344, 4, std::string(4, '\0'));
  header.replace(252, 4, std::string(4, '\1'));  // the orientation, and what is no sform here
  const LoadedImage loaded = read_image(folder_.write("c.hdr", header));
  EXPECT_EQ(loaded.image.position(Vec3(1, 1, 1)), Vec3(0.75, 1.25, 2.5));
  ASSERT_EQ(loaded.warnings.size(), 1u);
  expect_contains(loaded.warnings[0], "which side is left");
}

TEST_F(TwoFiles, WhatIsCutOffIsAnError) {
  for (std::size_t size = 0; size < voxels_.size(); size += 41) {
    const std::string cut = voxels_.substr(0, size);
    EXPECT_THROW(read_image(write_mhd(cut)), InvalidInput) << size;
    EXPECT_THROW(read_image(write_nhdr(cut)), InvalidInput) << size;
    EXPECT_THROW(read_image(write_pair(cut)), InvalidInput) << size;
  }
  for (const char* name : {"a.mhd", "b.nhdr", "c.hdr"}) {
    write_mhd(voxels_);
    write_nhdr(voxels_);
    write_pair(voxels_);
    const std::string header = content_of(folder_ / name);
    // The last lines of text headers may be cut off without loss.
    for (std::size_t size = 0; size < header.size() - 40; size += 9)
      EXPECT_THROW(read_image(folder_.write(name, header.substr(0, size))), Error) << name << " " << size;
  }
}

TEST_F(TwoFiles, AnotherFileThatIsMissingIsAnError) {
  for (const std::filesystem::path& path : {write_mhd(voxels_), write_nhdr(voxels_), write_pair(voxels_)}) {
    for (const char* data : {"a.raw", "b.raw", "c.img"}) std::filesystem::remove(folder_ / data);
    const std::string message = message_of<ReadError>([&] { read_image(path); });
    expect_contains(message, path.string() + ": its voxels are in another file");
    expect_contains(message, path.extension() == ".hdr" ? "c.img" : path.stem().string() + ".raw");
  }
  write_pair(voxels_);
  std::filesystem::remove(folder_ / "c.hdr");
  expect_contains(message_of<ReadError>([&] { read_image(folder_ / "c.img"); }), "c.hdr: there is no such file");
  EXPECT_THROW(read_image(folder_ / "there_is_none.mhd"), ReadError);
}

TEST_F(TwoFiles, HeadersThatAreWrongNeverCrash) {
  std::mt19937 random(5);
  for (int format = 0; format < 3; ++format) {
    const std::filesystem::path path = format == 0   ? write_mhd(voxels_)
                                       : format == 1 ? write_nhdr(voxels_)
                                                     : write_pair(voxels_);
    const std::string whole = content_of(path);
    for (int round = 0; round < 60; ++round) {
      std::string bytes = whole;
      for (int n = 0; n < 2; ++n) bytes[random() % bytes.size()] = static_cast<char>(random());
      try {
        read_image(folder_.write(path.filename().string(), bytes));
      } catch (const Error&) {
      }
    }
  }
}

TEST_F(TwoFiles, VoxelsInManyFilesAreRefused) {
  const std::string header = content_of(write_mhd(voxels_));
  for (const char* data : {"LIST", "%03d.raw 1 5 1"}) {
    folder_.write("a.mhd", replaced(header, "a.raw", data));
    folder_.write("b.nhdr", nrrd_header(image_, "short", std::string("encoding: raw\ndata file: ") + data + "\n"));
    for (const char* name : {"a.mhd", "b.nhdr"})
      expect_contains(message_of<Unsupported>([&] { read_image(folder_ / name); }), "many files");
  }
}

TEST_F(TwoFiles, AHugeClaimIsRefusedBeforeItIsRead) {
  std::string header = content_of(write_mhd(voxels_));
  header = replaced(header, "DimSize = 7 6 5", "DimSize = 70000 60000 50000");
  const std::string message = message_of<InvalidInput>([&] { read_image(folder_.write("a.mhd", header)); });
  expect_contains(message, "a.raw: the header claims 210000000000000 voxels");
}

TEST_F(TwoFiles, PackedVoxelsAreTheSame) {
  write_mhd(packed(voxels_, false));
  folder_.write("a.mhd", "CompressedData = True\n" + content_of(folder_ / "a.mhd"));
  expect_is_sample(folder_ / "a.mhd");
  write_nhdr(packed(voxels_, true));
  folder_.write("b.nhdr", replaced(content_of(folder_ / "b.nhdr"), "raw\ndata", "gzip\ndata"));
  expect_is_sample(folder_ / "b.nhdr");
}

TEST_F(TwoFiles, BytesBeforeTheVoxelsAreSkipped) {
  for (const char* skipped : {"3", "-1"}) {
    write_mhd("abc" + voxels_);
    const std::string size = std::string("HeaderSize = ") + skipped + "\n";
    expect_is_sample(folder_.write("a.mhd", size + content_of(folder_ / "a.mhd")));
    write_nhdr("abc" + voxels_);
    const std::string skip = std::string("byte skip: ") + skipped + "\n";
    expect_is_sample(
        folder_.write("b.nhdr", replaced(content_of(folder_ / "b.nhdr"), "data file", skip + "data file")));
  }
  write_pair(std::string(16, 'x') + voxels_);
  folder_.write("c.hdr", content_of(folder_ / "c.hdr").replace(108, 4, bytes_of(16.0f, false)));
  expect_is_sample(folder_ / "c.hdr");
  write_mhd("abc" + voxels_);
  for (const char* wrong : {"-2", "0.5", "1 2", "1e30", "x"})
    EXPECT_THROW(read_image(folder_.write("a.mhd", std::string("HeaderSize = ") + wrong + "\n" +
                                                       replaced(mha_header(image_, "MET_SHORT"), "LOCAL", "a.raw"))),
                 InvalidInput)
        << wrong;
}

TEST_F(TwoFiles, TheOtherFileIsNamedRelativeToTheHeaderInItsOwnCase) {
  std::filesystem::create_directory(folder_ / "Voxels");
  const std::filesystem::path data = folder_.write("Voxels/Two Words.RAW", voxels_);
  const std::string mhd = mha_header(image_, "MET_SHORT");
  for (const std::string& name : {std::string("Voxels/Two Words.RAW"), data.string()}) {
    expect_is_sample(folder_.write("a.mhd", replaced(mhd, "LOCAL", name)));
    expect_is_sample(folder_.write("b.nhdr", nrrd_header(image_, "short", "encoding: raw\ndata file: " + name + "\n")));
  }
  write_pair(voxels_);
  std::filesystem::rename(folder_ / "c.hdr", folder_ / "c.HDR");
  std::filesystem::rename(folder_ / "c.img", folder_ / "c.IMG");
  expect_is_sample(folder_ / "c.HDR");
  expect_is_sample(folder_ / "c.IMG");
}

TEST_F(TwoFiles, OneInMemoryIsRefused) {
  for (const std::filesystem::path& path : {write_mhd(voxels_), write_nhdr(voxels_), write_pair(voxels_)})
    expect_contains(message_of<Unsupported>([&] { parse_image(content_of(path), path.string()); }), "another file");
}

TEST_F(TwoFiles, AFolderOrAPipeInPlaceOfTheVoxelsIsAnError) {
  for (const char* data : {".", "/dev/zero"})
    EXPECT_THROW(read_image(folder_.write("a.mhd", replaced(mha_header(image_, "MET_SHORT"), "LOCAL", data))),
                 ReadError)
        << data;
}

}  // namespace
}  // namespace vmesh::testing

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "readers.h"
#include "shared_data.h"

namespace vmesh::testing {
namespace {

std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::exists(folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class Replay : public ::testing::TestWithParam<Reader> {
 protected:
  static void read(const std::string& content) { EXPECT_NO_THROW(GetParam().read(content)); }
};

TEST_P(Replay, SeedsAreRead) {
  for (const std::string& seed : GetParam().seeds()) EXPECT_EQ(GetParam().read(seed), Verdict::read) << seed;
}

TEST_P(Replay, CutSeedsAreReadOrRefused) {
  for (const std::string& seed : GetParam().seeds()) {
    for (std::size_t size = 0; size < seed.size(); ++size) read(seed.substr(0, size));
  }
}

// Every byte once turned into one that means something else, to a text reader and to a binary one.
TEST_P(Replay, DamagedSeedsAreReadOrRefused) {
  for (const std::string& seed : GetParam().seeds()) {
    for (std::size_t at = 0; at < seed.size(); ++at) {
      for (const char byte : {'\0', '9', ' ', '-', '\xff'}) {
        std::string damaged = seed;
        damaged[at] = byte;
        read(damaged);
      }
    }
  }
}

// Cases that once crashed, hung or leaked, as small as they could be made.
TEST_P(Replay, WhatFuzzingFoundIsReadOrRefused) {
  for (const auto& path : files_in(std::filesystem::path(VMESH_FOUND) / GetParam().name)) {
    SCOPED_TRACE(path);
    read(content_of(path));
  }
}

// Files of other formats, too: an ending may lie.
TEST_P(Replay, SharedAdversarialFilesAreReadOrRefused) {
  for (const std::string folder : {"adversarial_swc_neurom", "adversarial_mesh_trimesh"}) {
    VMESH_NEED_SHARED_DATA(folder);
    for (const auto& path : files_in(shared_data(folder))) {
      SCOPED_TRACE(path);
      read(content_of(path));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, Replay, ::testing::ValuesIn(readers()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace vmesh::testing

#pragma once

#include <filesystem>

#include <gtest/gtest.h>

namespace vmesh::testing {

/// Path of a file or folder of the shared test data (cache variable VMESH_SHARED_DATA).
inline std::filesystem::path shared_data(const std::string& relative) {
  return std::filesystem::path(VMESH_SHARED_DATA) / relative;
}

}  // namespace vmesh::testing

/// Ends the test as skipped, loudly, when the shared test data is not on this machine.
#define VMESH_NEED_SHARED_DATA(relative)                                                      \
  do {                                                                                        \
    if (!std::filesystem::exists(vmesh::testing::shared_data(relative)))                      \
      GTEST_SKIP() << "shared test data not found: " << vmesh::testing::shared_data(relative) \
                   << " (set the CMake cache variable VMESH_SHARED_DATA)";                    \
  } while (false)

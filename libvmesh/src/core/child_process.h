// For libraries that may crash or hang on damaged files. Internal to vmesh.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace vmesh {

/// Runs `work` in a child of this process and returns what it returns. What it throws as InvalidInput or Unsupported is
/// thrown here; a crash, too much memory or too much time of the processor become InvalidInput that names `source`.
/// `file_size`, in bytes, sets the limits: half of the memory that is free, and 30 s and 2 s for each megabyte.
std::string in_child_process(const std::string& source, std::size_t file_size,
                             const std::function<std::string()>& work);

}  // namespace vmesh

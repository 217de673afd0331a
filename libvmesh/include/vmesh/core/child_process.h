// For libraries that may crash or hang on damaged files. Internal to vmesh.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace vmesh {

/// Runs `work` in a child process and returns its result. Its InvalidInput and Unsupported exceptions are rethrown
/// here; a crash, too much memory or too much processor time become an InvalidInput naming `source`. The limits are
/// half of the free memory, and 30 s plus 2 s per megabyte of `file_size` (bytes).
std::string in_child_process(const std::string& source, std::size_t file_size,
                             const std::function<std::string()>& work);

}  // namespace vmesh

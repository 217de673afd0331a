#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace vmesh {

/// How much memory (bytes) this process may still allocate: the least of what the machine has free or can free and what
/// control groups and limits (RLIMIT_AS, RLIMIT_DATA) leave it. nullopt when the system does not tell.
std::optional<std::uint64_t> available_memory();

/// Throws Unsupported when `bytes` are more than available_memory(): "WHAT needs about 12.3 GB of memory and 4.5 GB are
/// free; ADVICE".
void require_memory(double bytes, const std::string& what, const std::string& advice);

/// Returns to the system what has been freed and the allocator keeps (glibc; elsewhere nothing happens): worth it after
/// a stage that freed gigabytes in small blocks.
void release_freed_memory();

}  // namespace vmesh

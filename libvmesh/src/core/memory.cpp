#include "vmesh/core/memory.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string_view>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>
#include <unistd.h>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"

namespace vmesh {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// The number after `key` in a file of lines "key: number kB".
std::optional<std::uint64_t> kilobytes(const char* path, std::string_view key) {
  std::ifstream file(path);
  for (std::string word; file >> word;) {
    std::uint64_t value = 0;
    if (word == key && file >> value) return value * 1024;
  }
  return std::nullopt;
}

std::uint64_t number_in(const std::string& path, std::uint64_t otherwise) {
  std::ifstream file(path);
  std::uint64_t value = 0;
  return file >> value ? value : otherwise;  // "max" is not a number
}

/// The least memory that a control group above the process leaves it (cgroups(7), version 2).
std::uint64_t left_by_groups() {
  std::ifstream file("/proc/self/cgroup");
  std::uint64_t least = kUnlimited;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("0::/")) continue;
    const std::string root = "/sys/fs/cgroup";
    for (std::string group = line.substr(3);; group.erase(group.rfind('/'))) {
      const std::string folder = root + (group == "/" ? "" : group);
      const std::uint64_t most = number_in(folder + "/memory.max", kUnlimited);
      if (most != kUnlimited) {
        const std::uint64_t used = number_in(folder + "/memory.current", 0);
        least = std::min(least, most - std::min(most, used));
      }
      if (group.empty() || group == "/") break;
    }
  }
  return least;
}

#ifdef __GLIBC__
using LimitedResource = __rlimit_resource;
#else
using LimitedResource = int;
#endif

/// What remains of the limit `resource` when `used` is spent.
std::uint64_t left_by_limit(LimitedResource resource, std::uint64_t used) {
  rlimit limit = {};
  if (::getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used);
}

std::string gigabytes(double bytes) { return formatted("%.3g GB", bytes / 1e9); }

}  // namespace

std::optional<std::uint64_t> available_memory() {
  std::uint64_t least = kilobytes("/proc/meminfo", "MemAvailable:").value_or(kUnlimited);
  least = std::min(least, left_by_groups());
  least = std::min(least, left_by_limit(RLIMIT_AS, kilobytes("/proc/self/status", "VmSize:").value_or(0)));
  least = std::min(least, left_by_limit(RLIMIT_DATA, kilobytes("/proc/self/status", "VmData:").value_or(0)));
  if (least == kUnlimited) return std::nullopt;
  return least;
}

void require_memory(double bytes, const std::string& what, const std::string& advice) {
  const auto available = available_memory();
  if (!available || bytes <= static_cast<double>(*available)) return;
  throw Unsupported(what + " needs about " + gigabytes(bytes) + " of memory and " +
                    gigabytes(static_cast<double>(*available)) + " are free; " + advice);
}

void release_freed_memory() {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

}  // namespace vmesh

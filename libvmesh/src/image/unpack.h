// zlib and gzip, internal to the module.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vmesh::image {

/// The first `at_most` bytes that `packed` holds, or all when it holds less; what is broken ends them. Memory is
/// bounded by what comes out, whatever was promised.
std::string unpacked(std::string_view packed, std::uint64_t at_most);

}  // namespace vmesh::image

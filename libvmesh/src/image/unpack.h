// zlib and gzip, internal to the module.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vmesh::image {

/// The first `at_most` uncompressed bytes of `packed`, or fewer if it ends or is damaged earlier. Memory is bounded by
/// the actual output, whatever a header claims.
std::string unpacked(std::string_view packed, std::uint64_t at_most);

}  // namespace vmesh::image

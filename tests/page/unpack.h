#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vmesh::testing {

std::string from_base64(const std::string& text);

/// All integers in a page's text; the reverse of pack().
std::vector<std::int64_t> unpack(const std::string& text, std::size_t stride = 1);

}  // namespace vmesh::testing

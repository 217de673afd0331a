#pragma once

#include <string_view>

namespace vmesh::tool {

/// A literal without its final 0; others within are kept.
template <std::size_t size>
constexpr std::string_view view(const char (&text)[size]) {
  return {text, size - 1};
}

}  // namespace vmesh::tool

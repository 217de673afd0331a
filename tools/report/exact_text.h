#pragma once

#include <charconv>
#include <string>

namespace vmesh::tool {

/// The shortest text that reads back as the same number.
template <class Number>
std::string exact_text(Number value) {
  char text[32];
  return {text, std::to_chars(std::begin(text), std::end(text), value).ptr};
}

}  // namespace vmesh::tool

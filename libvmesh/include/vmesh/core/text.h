// Text for users and files.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace vmesh {

/// What std::printf() would print, up to 511 letters.
template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// "1 loop", "2 loops".
inline std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count).append(" ").append(count == 1 ? one : many);
}

/// Text in which the letters of XML that are in `which` are written as entities.
std::string xml_escaped(std::string_view text, std::string_view which);

}  // namespace vmesh

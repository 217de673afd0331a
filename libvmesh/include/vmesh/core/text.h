// Text for users and files.
#pragma once

#include <string>
#include <string_view>

#include "vmesh/core/types.h"

namespace vmesh {

/// What std::printf() would print.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

/// "1 loop", "2 loops".
inline std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count).append(" ").append(count == 1 ? one : many);
}

/// "(1.000, 2.500, -3.000)": a place in a message.
std::string point_text(const Vec3& p);

/// Without blanks, tabs and line ends around it.
std::string_view trimmed(std::string_view text);

/// Text in which the letters of XML that are in `which` are written as entities.
std::string xml_escaped(std::string_view text, std::string_view which);

}  // namespace vmesh

#include "vmesh/core/text.h"

#include <algorithm>
#include <cctype>
#include <cstdarg>
#include <cstdio>
#include <utility>

namespace vmesh {

std::string formatted(const char* format, ...) {
  std::va_list values, again;
  va_start(values, format);
  va_copy(again, values);
  std::string text(static_cast<std::size_t>(std::max(0, std::vsnprintf(nullptr, 0, format, values))), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  va_end(values);
  return text;
}

std::string point_text(const Vec3& p) { return formatted("(%.3f, %.3f, %.3f)", p.x(), p.y(), p.z()); }

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string xml_escaped(std::string_view text, std::string_view which) {
  constexpr std::pair<char, const char*> kEntities[] = {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  std::string escaped;
  for (const char c : text) {
    const char* entity = nullptr;
    for (const auto& [letter, name] : kEntities) {
      if (c == letter && which.find(c) != std::string_view::npos) entity = name;
    }
    if (entity) {
      escaped += entity;
    } else {
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace vmesh

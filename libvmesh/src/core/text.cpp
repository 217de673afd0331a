#include "vmesh/core/text.h"

#include <algorithm>
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

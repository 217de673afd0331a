#include "vmesh/core/text.h"

#include <utility>

namespace vmesh {

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

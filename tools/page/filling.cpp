#include "page/filling.h"

#include "vmesh/core/text.h"

namespace vmesh::tool {

std::string html_escaped(std::string_view text) { return xml_escaped(text, "&<>"); }

std::string script_safe(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string filled(std::string_view text, const std::vector<std::pair<std::string_view, std::string_view>>& parts) {
  std::string result;
  while (!text.empty()) {
    std::size_t at = text.size();
    const std::pair<std::string_view, std::string_view>* next = nullptr;
    for (const auto& part : parts) {
      const std::size_t found = text.find(part.first);
      if (found < at) at = found, next = &part;
    }
    result += text.substr(0, at);
    if (!next) break;
    result += next->second;
    text.remove_prefix(at + next->first.size());
  }
  return result;
}

}  // namespace vmesh::tool

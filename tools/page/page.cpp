#include "page/page.h"

#include <string_view>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"

#include "page/page_json.h"
#include "page/page_parts.h"

namespace vmesh::tool {
namespace {

std::string escaped(std::string_view text) { return xml_escaped(text, "&<>"); }

/// JSON for use between <script> tags: it must not contain anything like the end tag.
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

/// The template with every "@NAME@" replaced; replacements are not scanned again.
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

}  // namespace

std::string to_html(const Page& page) {
  const PageParts& parts = page_parts();
  const Json json = to_json(page);
  const std::string title = escaped(json["title"].get<std::string>() + " \u2013 vmesh " + page.verb);
  // Text that is not UTF-8 is repaired, as in every JSON.
  const std::string data = script_safe(json.dump(-1, ' ', false, Json::error_handler_t::replace));
  return filled(parts.page, {{"@TITLE@", title},
                             {"@STYLE@", parts.style},
                             {"@DATA@", data},
                             {"@LICENSE@", parts.license},
                             {"@THREE@", parts.three},
                             {"@SCRIPT@", parts.script}});
}

}  // namespace vmesh::tool

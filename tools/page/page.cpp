#include "page/page.h"

#include "page/filling.h"
#include "page/page_json.h"
#include "page/page_parts.h"

namespace vmesh::tool {

std::string to_html(const Page& page) {
  const PageParts& parts = page_parts();
  const Json json = to_json(page);
  const std::string title = html_escaped(json["title"].get<std::string>() + " \u2013 vmesh " + page.verb);
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

#include "vmesh/core/text.h"

#include "command_line/outputs.h"
#include "page/page.h"

namespace vmesh::tool {

void write_page(const std::filesystem::path& path, const Page& page, Console& console) {
  const std::string html = to_html(page);
  write_text(path, html);
  console.log("wrote " + path.string() + formatted(", %.1f MB", static_cast<double>(html.size()) / 1e6) +
              ": open it in a browser");
}

}  // namespace vmesh::tool

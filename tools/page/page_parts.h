#pragma once

#include <string_view>

namespace vmesh::tool {

/// The parts of pages; the build embeds them in the command (see embed.cmake).
struct PageParts {
  std::string_view page, style, script;
  std::string_view three, license;  ///< what is used of three.js, and its licence; empty: not built in
};
const PageParts& page_parts();

}  // namespace vmesh::tool

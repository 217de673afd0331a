#pragma once

#include <string_view>

namespace vmesh::tool {

/// The parts of pages that move; the build embeds them in the command (see embed.cmake here).
struct LiveParts {
  std::string_view page, style, first, script;
  std::string_view three, license;
  std::string_view deformer;  ///< the module `deform`; empty: not built in
};
const LiveParts& live_parts();

}  // namespace vmesh::tool

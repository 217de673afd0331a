// In a build without emscripten: check_outputs() has refused such pages before.
#include "vmesh/core/error.h"

#include "page/live/live_page.h"

namespace vmesh::tool {

std::string to_html(const LivePage&) { throw Unsupported("--live: this vmesh was built without pages that move"); }

}  // namespace vmesh::tool

#pragma once

#include <string>

namespace vmesh::tool {

/// "vmesh" and the other words of a command line, quoted so that a shell reads the same words.
std::string quoted_command(int argc, const char* const* argv);

}  // namespace vmesh::tool

#pragma once

#include <memory>

#include "command_line/verb.h"

namespace vmesh::tool {

/// Parses the command line, see Verb::settle(). Returns the verb to run, or null if the command is finished with
/// `exit_code`: help, version or a usage error was printed.
std::unique_ptr<Verb> parse_arguments(int argc, const char* const* argv, int& exit_code);

}  // namespace vmesh::tool

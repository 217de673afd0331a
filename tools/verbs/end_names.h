// The names that users give to the ends of vessels.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vmesh/surface/surface_attributes.h"

#include "verbs/generate_arguments.h"

namespace CLI {  // NOLINT(readability-identifier-naming): a library's
class App;
}

namespace vmesh::tool {

/// Adds --name and --names.
void add_end_names(CLI::App& verb, EndNameArguments& arguments);

/// Adds --regions branches, for which `take` is called.
void add_regions(CLI::App& verb, const std::function<void()>& take, const std::string& help);

/// Reads the table, if any. Throws InvalidInput for what is neither "NODE=NAME" nor a row of the table, for nodes that
/// are no ends, ends that are named twice, names that are not good (check_patch_names()) or that other patches have,
/// and positions that are not at an end.
std::vector<EndName> read_end_names(const EndNameArguments& arguments, const Centerline& centerline);

}  // namespace vmesh::tool

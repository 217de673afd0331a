// Ids of nodes in text files, internal to the module.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vmesh::io {

/// The id as a key: integers of any size in one spelling ("7" for 7, +7, 07 and 7.0), anything else as it is. nullopt
/// if it is empty or a number that is no integer.
std::optional<std::string> parse_id(std::string_view text);

/// The id on one line and shortened, for messages.
std::string shown_id(const std::string& id);

}  // namespace vmesh::io

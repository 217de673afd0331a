// Templates of pages, and texts in them.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vmesh::tool {

std::string html_escaped(std::string_view text);

/// JSON for use between <script> tags: it must not contain anything like the end tag.
std::string script_safe(const std::string& json);

/// The template with every "@NAME@" replaced; replacements are not scanned again.
std::string filled(std::string_view text, const std::vector<std::pair<std::string_view, std::string_view>>& parts);

}  // namespace vmesh::tool

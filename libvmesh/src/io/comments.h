#pragma once

#include <string>
#include <string_view>

#include "vmesh/centerline/raw_centerline.h"

#include "text.h"

namespace vmesh::io {

/// Frame and unit of the numbers, then generator, options and input as far as known: each on a line of its own, after
/// `prefix`.
template <class Metadata>
std::string comments(const Metadata& metadata, std::string_view prefix) {
  std::string text;
  const auto add = [&](std::string_view key, std::string_view value) {
    if (!value.empty()) text.append(prefix).append(key).append(one_line(value)).append("\n");
  };
  add("SPACE=", to_string(metadata.space));
  add("UNIT=", to_string(metadata.unit));
  add("generator: ", metadata.generator);
  add("options: ", metadata.options);
  add("input: ", metadata.input_name);
  add("input sha256: ", metadata.input_sha256);
  return text;
}

}  // namespace vmesh::io

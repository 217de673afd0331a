// What tables of file formats have in common: each kind of file has a vector of entries with `name` and `extensions`.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vmesh {

/// Lower case of ASCII letters.
std::string lower(std::string_view text);

/// Lower-case extension with its dot.
std::string extension_of(const std::filesystem::path& path);

/// ".ply, .stl or .obj", with `last` before the last word.
std::string listed(const std::vector<std::string>& words, const std::string& last = "or");

/// The longest of the extensions that the file's name ends with, after at least one other letter; empty: none. Upper or
/// lower case.
std::string longest_extension(const std::filesystem::path& path, const std::vector<std::string>& extensions);

/// A part of vmesh that a build may leave out, by its CMake option VMESH_WITH_..., and the formats to use then.
struct OptionalPart {
  const char* name = nullptr;
  const char* instead = nullptr;
};

/// Throws Unsupported: reading the file needs the part.
[[noreturn]] void refuse_without(const OptionalPart& part, const std::filesystem::path& path);

/// The format whose extension the file's name has; null if there is none.
template <class Format>
const Format* find_format(const std::vector<Format>& formats, const std::filesystem::path& path) {
  const Format* found = nullptr;
  std::size_t longest = 0;
  for (const Format& format : formats) {
    const std::size_t length = longest_extension(path, format.extensions).size();
    if (length <= longest) continue;
    longest = length;
    found = &format;
  }
  return found;
}

/// The extensions of the formats for which `wanted` holds, in their order.
template <class Format, class Wanted>
std::vector<std::string> extensions_of(const std::vector<Format>& formats, Wanted wanted) {
  std::vector<std::string> extensions;
  for (const Format& format : formats) {
    if (wanted(format)) extensions.insert(extensions.end(), format.extensions.begin(), format.extensions.end());
  }
  return extensions;
}

}  // namespace vmesh

#include "vmesh/core/file_format.h"

#include <algorithm>
#include <cctype>

#include "vmesh/core/error.h"

namespace vmesh {

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(text.begin(), text.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
  return result;
}

std::string extension_of(const std::filesystem::path& path) { return lower(path.extension().string()); }

std::string listed(const std::vector<std::string>& words, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " " + last + " " : ", ") + words[i];
  return text;
}

std::string longest_extension(const std::filesystem::path& path, const std::vector<std::string>& extensions) {
  const std::string name = lower(path.filename().string());
  std::string longest;
  for (const std::string& extension : extensions) {
    if (name.size() > extension.size() && name.ends_with(extension) && extension.size() > longest.size())
      longest = extension;
  }
  return longest;
}

void refuse_without(const OptionalPart& part, const std::filesystem::path& path) {
  const std::string name = part.name;
  std::string option = "VMESH_WITH_" + name;
  std::transform(option.begin(), option.end(), option.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  throw Unsupported(path.string() + ": reading this format needs " + name + " and this vmesh was built without " +
                    name + " (CMake option " + option + "); build it with, or convert the file to " + part.instead);
}

}  // namespace vmesh

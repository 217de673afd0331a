#include "vmesh/mesh/patch_names.h"

#include <algorithm>
#include <set>

#include "vmesh/core/error.h"
#include "vmesh/core/file_format.h"

namespace vmesh {
namespace {

// CalculiX reads 80 characters of a set's name; endings are added to ours.
constexpr std::size_t kLongestName = 60;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_name_letter(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.'; }

/// Of any bytes, for a message.
std::string shown(std::string_view name) {
  std::string text(name.substr(0, kLongestName));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "\"" + text + (name.size() > kLongestName ? "...\"" : "\"");
}

}  // namespace

bool is_patch_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && is_letter(name[0]) &&
         std::all_of(name.begin(), name.end(), is_name_letter);
}

bool is_wall_name(std::string_view name) { return lower(name).starts_with("wall"); }

bool is_wall_patch(std::size_t number, const std::vector<std::string>& names) {
  if (std::none_of(names.begin(), names.end(), is_wall_name)) return number == 1;
  return number >= 1 && number <= names.size() && is_wall_name(names[number - 1]);
}

void check_patch_names(const std::vector<std::string>& names, const char* word, const char* words) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (!is_patch_name(name))
      throw InvalidInput(shown(name) + " cannot be the name of a " + word +
                         "; names are letters, digits, _, - and ., a letter first, at most " +
                         std::to_string(kLongestName));
    if (!seen.insert(lower(name)).second)
      throw InvalidInput(std::string("two ") + words + " have the name \"" + name + "\", in upper or lower case");
  }
}

}  // namespace vmesh

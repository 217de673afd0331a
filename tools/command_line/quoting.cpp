#include "command_line/quoting.h"

#include <string_view>

namespace vmesh::tool {
namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-_=./,:+@%").find(c) != std::string_view::npos;
}

std::string quoted(std::string_view word) {
  bool plain = !word.empty();
  for (const char c : word) plain &= is_plain(c);
  if (plain) return std::string(word);
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::string quoted_command(int argc, const char* const* argv) {
  std::string text = "vmesh";
  for (int i = 1; i < argc; ++i) text += " " + quoted(argv[i]);
  return text;
}

}  // namespace vmesh::tool

#include "node_id.h"

#include <algorithm>

#include "text.h"

namespace vmesh::io {
namespace {

bool all_digits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::optional<std::string> parse_id(std::string_view text) {
  if (text.empty()) return std::nullopt;
  const bool negative = text.front() == '-';
  std::string_view digits = text.substr(negative || text.front() == '+' ? 1 : 0);
  if (all_digits(digits)) {
    digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size() - 1));
    return (negative && digits != "0" ? "-" : "") + std::string(digits);
  }
  if (const auto integer = parse_integer(text)) return std::to_string(*integer);
  if (parse_double(text)) return std::nullopt;
  return std::string(text);
}

std::string shown_id(const std::string& id) {
  constexpr std::size_t kMostShown = 40;
  return one_line(id.substr(0, kMostShown)) + (id.size() > kMostShown ? "..." : "");
}

}  // namespace vmesh::io

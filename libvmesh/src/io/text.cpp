#include "text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace vmesh::io {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r'; }

/// The word after `key` in `text`, matched without regard to case.
std::string_view value_after(std::string_view text, std::string_view key) {
  const std::string folded = lower(text);
  const std::size_t at = folded.find(key);
  if (at == std::string::npos) return {};
  std::string_view rest = text.substr(at + key.size());
  std::size_t end = 0;
  while (end < rest.size() && !is_blank(rest[end]) && rest[end] != ',' && rest[end] != ';' && rest[end] != '\0') ++end;
  return rest.substr(0, end);
}

template <class Real>
void append_shortest(std::string& text, Real value) {
  char buffer[40];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  text.append(buffer, result.ptr);
}

}  // namespace

LineReader::LineReader(std::string_view text) : text_(text) {
  if (text_.substr(0, 3) == "\xEF\xBB\xBF") text_.remove_prefix(3);
}

bool LineReader::next(std::string_view& line) {
  if (text_.empty()) return false;
  ++number_;
  const std::size_t end = text_.find_first_of("\r\n");
  if (end == std::string_view::npos) {
    line = text_;
    text_ = {};
    return true;
  }
  line = text_.substr(0, end);
  const bool crlf = text_[end] == '\r' && end + 1 < text_.size() && text_[end + 1] == '\n';
  text_.remove_prefix(end + (crlf ? 2 : 1));
  return true;
}

std::string_view LineReader::take(std::size_t count) {
  const std::string_view bytes = text_.substr(0, count);
  text_.remove_prefix(bytes.size());
  return bytes;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

void split_blank(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  std::size_t i = 0;
  while (true) {
    while (i < line.size() && is_blank(line[i])) ++i;
    if (i == line.size()) return;
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i])) ++i;
    fields.push_back(line.substr(begin, i - begin));
  }
}

std::optional<double> parse_double(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  double value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ptr != end || text.empty()) return std::nullopt;
  if (result.ec == std::errc::result_out_of_range) {
    const std::size_t e = text.find_first_of("eE");
    const bool tiny = e != std::string_view::npos && e + 1 < text.size() && text[e + 1] == '-';
    const double magnitude = tiny || text.find_first_of("123456789") == std::string_view::npos
                                 ? 0.0
                                 : std::numeric_limits<double>::infinity();
    return text.front() == '-' ? -magnitude : magnitude;
  }
  if (result.ec != std::errc()) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  const auto value = parse_double(text);
  if (!value || !std::isfinite(*value) || std::abs(*value) > 0x1p53 || *value != std::floor(*value))
    return std::nullopt;
  return static_cast<std::int64_t>(*value);
}

void append(std::string& text, double value) { append_shortest(text, value); }
void append(std::string& text, float value) { append_shortest(text, value); }

void append(std::string& text, std::uint64_t value) { text += std::to_string(value); }

void read_tags(std::string_view comment, LengthUnit& unit, Space& space) {
  if (const auto value = parse_space(value_after(comment, "space="))) space = *value;
  if (const auto value = parse_length_unit(value_after(comment, "unit="))) unit = *value;
}

bool says_voxels(std::string_view comment) { return lower(value_after(comment, "unit=")).starts_with("voxel"); }

void refuse_utf16(std::string_view content, const std::string& source) {
  const std::string_view begin = content.substr(0, 2);
  if (begin != "\xFF\xFE" && begin != "\xFE\xFF" && begin.find('\0') == std::string_view::npos) return;
  throw InvalidInput(source + ": line 1: this is text in UTF-16; save it as UTF-8 (in Excel as \"CSV UTF-8\")");
}

std::string one_line(std::string_view text) {
  std::string result(text);
  std::replace_if(
      result.begin(), result.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  return result;
}

std::string cite(std::string_view text) {
  constexpr std::size_t kMaxShown = 40;
  std::string shown = one_line(text.substr(0, kMaxShown));
  if (text.size() > kMaxShown) shown += "...";
  return "\"" + shown + "\"";
}

}  // namespace vmesh::io

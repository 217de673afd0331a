// Helpers for text files, internal to the module. Numbers are read and written without regard to the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/centerline/raw_centerline.h"
#include "vmesh/core/error.h"
#include "vmesh/core/file_format.h"

namespace vmesh::io {

/// A line at a time; ends with LF, CRLF or CR.
class LineReader {
 public:
  explicit LineReader(std::string_view text);
  bool next(std::string_view& line);
  std::uint64_t number() const { return number_; }  ///< of the last line, from 1
  std::string_view rest() const { return text_; }
  /// The next `count` bytes, whatever they are; there must be that many.
  std::string_view take(std::size_t count);

 private:
  std::string_view text_;
  std::uint64_t number_ = 0;
};

std::string_view trim(std::string_view text);

/// Fields between spaces and tabs; `fields` is reused.
void split_blank(std::string_view line, std::vector<std::string_view>& fields);

/// The whole of `text` as a number (also "nan" and "inf"; a leading + is allowed). Overflow gives infinity, underflow
/// zero.
std::optional<double> parse_double(std::string_view text);

/// An integer of at most 2^53, also if written like 12.0 or 1.2e1.
std::optional<std::int64_t> parse_integer(std::string_view text);

/// Appends the shortest text that reads back as `value`.
void append(std::string& text, double value);
void append(std::string& text, float value);
void append(std::string& text, std::uint64_t value);

/// Looks for SPACE=... and UNIT=... in a comment.
void read_tags(std::string_view comment, LengthUnit& unit, Space& space);

/// Whether a comment says UNIT=voxels.
bool says_voxels(std::string_view comment);

/// Throws InvalidInput for text of two bytes per character.
void refuse_utf16(std::string_view content, const std::string& source);

/// `text` on one line: control characters become blanks.
std::string one_line(std::string_view text);

/// `text` in quotes, on one line and shortened for a message.
std::string cite(std::string_view text);

}  // namespace vmesh::io

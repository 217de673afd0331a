// Rows of words and numbers in text, internal to the module.
#pragma once

#include <concepts>
#include <ostream>
#include <string>
#include <string_view>

#include "vmesh/core/types.h"

#include "bytes.h"
#include "text.h"

namespace vmesh::io {

/// Writes in blocks what is added; the rest in the end.
class TextRows {
 public:
  explicit TextRows(std::ostream& out, std::string between = " ") : out_(out), between_(std::move(between)) {}
  ~TextRows() { write_out(out_, bytes_); }
  TextRows(const TextRows&) = delete;
  TextRows& operator=(const TextRows&) = delete;

  void line(std::string_view text) { bytes_.append(text).append("\n"); }

  /// A row of words, numbers and positions. Real numbers have the digits they need to come back to the bit.
  template <class... Values>
  void row(const Values&... values) {
    (add(values), ...);
    end_row();
  }

  void add(std::string_view word) { begin().append(word); }
  void add(std::integral auto number) { begin().append(std::to_string(number)); }
  void add(double number) { append(begin(), number); }
  void add(const Vec3& position) {
    for (const double x : position) add(x);
  }
  void end_row() {
    bytes_ += '\n';
    is_in_row_ = false;
    write_blocks(out_, bytes_);
  }

 private:
  std::string& begin() {
    if (is_in_row_) bytes_ += between_;
    is_in_row_ = true;
    return bytes_;
  }

  std::ostream& out_;
  std::string between_, bytes_;
  bool is_in_row_ = false;
};

}  // namespace vmesh::io

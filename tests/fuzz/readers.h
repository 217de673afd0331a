// Every reader of the library by name, for fuzzing and for replaying the findings.
#pragma once

#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vmesh::testing {

enum class Verdict { read, refused };

struct Reader {
  std::string_view name;    ///< "swc", "surface_vtp", "nii_gz" ...
  std::string_view ending;  ///< of its files, ".swc"

  /// Reads a file's content like programs do: centerlines are also cleaned. InvalidInput and Unsupported are refusals.
  /// Any other exception is a finding; std::logic_error is thrown if the result is inconsistent or the message of a
  /// refusal is not presentable.
  Verdict (*read)(std::string_view content);

  /// Small valid files that show what the format can do.
  std::vector<std::string> (*seeds)();
};

inline void PrintTo(const Reader& reader, std::ostream* out) { *out << reader.name; }

std::span<const Reader> readers();

/// Throws std::invalid_argument when there is none.
const Reader& reader_named(std::string_view name);

/// The two files of a CSV pair travel as one, nodes first, with this between them.
constexpr char kCsvSeparator = '\f';

}  // namespace vmesh::testing

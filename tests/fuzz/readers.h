// Every reader of the library by name, for fuzzing and for replaying the findings.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "seeds.h"

namespace vmesh::testing {

enum class Verdict { read, refused };

struct Reader {
  std::string name;    ///< "swc", "surface_vtp", "nii_gz" ...: from the extension
  std::string ending;  ///< of its files, ".swc"

  /// Reads a file's content like programs do: centerlines are also cleaned. InvalidInput and Unsupported are refusals.
  /// Any other exception is a finding; std::logic_error is thrown if the result is inconsistent or the message of a
  /// refusal is not presentable.
  std::function<Verdict(std::string_view content)> read;

  /// Small valid files that show what the format can do.
  MakeSeeds seeds;
};

inline void PrintTo(const Reader& reader, std::ostream* out) { *out << reader.name; }

/// Of every format in the library's tables that is read from memory. Throws std::logic_error for one without seeds.
const std::vector<Reader>& readers();

/// Throws std::invalid_argument when there is none.
const Reader& reader_named(std::string_view name);

/// The two files of a CSV pair travel as one, nodes first, with this between them.
constexpr char kCsvSeparator = '\f';

}  // namespace vmesh::testing

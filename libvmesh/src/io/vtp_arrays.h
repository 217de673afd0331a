// The data arrays of VTK's XML files (VTK File Formats, "XML File Formats"), internal to the module.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "xml.h"

namespace vmesh::io {

class VtpArrays {
 public:
  /// Of a file whose root is `root`. Throws Unsupported for packings other than zlib's. Both arguments must outlive it.
  VtpArrays(const XmlFile& file, const std::string& source);

  /// The first `count` numbers of a <DataArray>; kAll: all there are. Throws InvalidInput when there are fewer: nothing
  /// is allocated for numbers that are not there.
  static constexpr std::uint64_t kAll = ~std::uint64_t{0};
  std::vector<double> numbers(const XmlElement& array, std::uint64_t count);

  /// The first text of a <DataArray type="String">; empty when there is none or it cannot be read.
  std::string text(const XmlElement& array);

 private:
  [[noreturn]] void fail(const XmlElement& array, const std::string& what) const;
  std::string_view appended(const XmlElement& array) const;
  std::string bytes(const XmlElement& array, std::uint64_t most);
  std::string plain(const XmlElement& array, std::string_view& stored, bool base64, std::uint64_t most) const;
  std::string unpacked(const XmlElement& array, std::string_view& stored, bool base64, std::uint64_t most) const;
  std::uint64_t header_word(std::string_view bytes, std::size_t i) const;
  std::vector<double> words(const XmlElement& array, std::uint64_t count) const;

  const XmlFile& file_;
  const std::string& source_;
  const XmlElement* appended_ = nullptr;
  bool big_endian_ = false, packed_ = false;
  std::size_t word_size_ = 4;    ///< of the numbers before binary data
  std::uint64_t appended_left_;  ///< bytes of the appended data that no array has taken
};

}  // namespace vmesh::io

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
  /// Throws Unsupported for compression other than zlib's. Both arguments must outlive it.
  VtpArrays(const XmlFile& file, const std::string& source);

  /// The first `count` numbers of a <DataArray>; kAll: all of them. Throws InvalidInput if there are fewer; allocates
  /// nothing for missing numbers.
  static constexpr std::uint64_t kAll = ~std::uint64_t{0};
  std::vector<double> numbers(pugi::xml_node array, std::uint64_t count);

  /// The first text of a <DataArray type="String">; empty when there is none or it cannot be read.
  std::string text(pugi::xml_node array);

  /// All texts of it, each ended by a zero.
  std::vector<std::string> texts(pugi::xml_node array);

 private:
  [[noreturn]] void fail(pugi::xml_node array, const std::string& what) const;
  std::string_view appended(pugi::xml_node array) const;
  std::string bytes(pugi::xml_node array, std::uint64_t most);
  std::string characters(pugi::xml_node array, std::uint64_t most);
  std::string plain(pugi::xml_node array, std::string_view& stored, bool base64, std::uint64_t most) const;
  std::string unpacked(pugi::xml_node array, std::string_view& stored, bool base64, std::uint64_t most) const;
  std::uint64_t header_word(std::string_view bytes, std::size_t i) const;
  std::vector<double> words(pugi::xml_node array, std::uint64_t count) const;

  const XmlFile& file_;
  const std::string& source_;
  bool big_endian_ = false, packed_ = false, raw_appended_ = false;
  std::size_t word_size_ = 4;    ///< of the numbers before binary data
  std::uint64_t appended_left_;  ///< bytes of the appended data that no array has taken
};

}  // namespace vmesh::io

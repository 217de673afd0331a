// Archives of files, internal to the module.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vmesh::io {

/// A ZIP archive in memory (PKWARE's APPNOTE.TXT 6.3.10, 4.3), its files compressed by deflate and dated 1980, the
/// first year that it knows, so that equal content makes equal bytes.
class ZipArchive {
 public:
  /// `name`: in ASCII. Throws Unsupported for 4 GiB or more.
  void add(const std::string& name, std::string_view content);
  /// To be called once.
  std::string finish();

 private:
  std::string bytes_, directory_;
  std::size_t count_ = 0;
};

}  // namespace vmesh::io

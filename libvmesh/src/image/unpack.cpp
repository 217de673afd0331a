#include "unpack.h"

#include <algorithm>
#include <array>
#include <limits>
#include <new>

#include <zlib.h>

namespace vmesh::image {

std::string unpacked(std::string_view packed, std::uint64_t at_most) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 32) != Z_OK) throw std::bad_alloc();  // 32: detects zlib or gzip
  std::string result;
  std::array<char, 1 << 16> buffer;
  int state = Z_OK;
  while (state == Z_OK && result.size() < at_most) {
    if (stream.avail_in == 0) {
      const std::size_t block = std::min<std::size_t>(packed.size(), std::size_t{1} << 30);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
      stream.avail_in = static_cast<uInt>(block);
      packed.remove_prefix(block);
    }
    stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
    stream.avail_out = static_cast<uInt>(buffer.size());
    state = inflate(&stream, Z_NO_FLUSH);  // Z_BUF_ERROR at the end of the input
    const std::uint64_t count = buffer.size() - stream.avail_out;
    result.append(buffer.data(), static_cast<std::size_t>(std::min(count, at_most - result.size())));
  }
  inflateEnd(&stream);
  return result;
}

}  // namespace vmesh::image

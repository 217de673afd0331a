// Numbers in binary files, internal to the module.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <ostream>
#include <string>

#include "vmesh/core/stored_number.h"

namespace vmesh::io {

/// Appends `value` in little-endian order.
template <class T>
void store(std::string& bytes, T value) {
  auto buffer = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native == std::endian::big) std::reverse(buffer.begin(), buffer.end());
  bytes.append(buffer.data(), buffer.size());
}

/// Writes `bytes` and empties it.
inline void write_out(std::ostream& out, std::string& bytes) {
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.clear();
}

/// The same once a block is full, so that no large file is in memory as a whole.
inline void write_blocks(std::ostream& out, std::string& bytes) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  if (bytes.size() >= kBlock) write_out(out, bytes);
}

}  // namespace vmesh::io

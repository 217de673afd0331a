#include "zip_archive.h"

#include <cstdint>
#include <limits>

#include <zlib.h>

#include "vmesh/core/error.h"

#include "bytes.h"

namespace vmesh::io {
namespace {

constexpr std::uint32_t kLocalHeader = 0x04034b50, kDirectoryEntry = 0x02014b50, kDirectoryEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 20, kDeflated = 8;  // 2.0 has deflate
constexpr std::uint16_t kMidnight = 0, kFirstDay = (1 << 5) | 1;

std::uint32_t checked_size(std::size_t size) {
  if (size > std::numeric_limits<std::uint32_t>::max()) throw Unsupported("an archive of 4 GiB or more");
  return static_cast<std::uint32_t>(size);
}

/// Without the header of zlib's own format.
std::string deflated(std::string_view content) {
  z_stream stream = {};
  constexpr int kRaw = -15, kMemory = 8;
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kRaw, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string packed(deflateBound(&stream, content.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = checked_size(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = checked_size(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

}  // namespace

void ZipArchive::add(const std::string& name, std::string_view content) {
  const std::uint32_t size = checked_size(content.size()), offset = checked_size(bytes_.size());
  const std::string packed = deflated(content);
  const auto sum = static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(content.data()), size));
  const auto add_common = [&](std::string& to) {
    for (const std::uint16_t value : {kVersion, std::uint16_t{0}, kDeflated, kMidnight, kFirstDay}) store(to, value);
    store(to, sum);
    store(to, checked_size(packed.size()));
    store(to, size);
    store(to, static_cast<std::uint16_t>(name.size()));
    store(to, std::uint16_t{0});  // extra fields
  };
  store(bytes_, kLocalHeader);
  add_common(bytes_);
  bytes_ += name + packed;
  store(directory_, kDirectoryEntry);
  store(directory_, kVersion);
  add_common(directory_);
  for (int zero = 0; zero < 3; ++zero) store(directory_, std::uint16_t{0});  // comment, disk, kind
  store(directory_, std::uint32_t{0});                                       // rights
  store(directory_, offset);
  directory_ += name;
  ++count_;
}

std::string ZipArchive::finish() {
  const std::uint32_t offset = checked_size(bytes_.size());
  bytes_ += directory_;
  store(bytes_, kDirectoryEnd);
  store(bytes_, std::uint32_t{0});  // disks
  store(bytes_, static_cast<std::uint16_t>(count_));
  store(bytes_, static_cast<std::uint16_t>(count_));
  store(bytes_, checked_size(directory_.size()));
  store(bytes_, offset);
  store(bytes_, std::uint16_t{0});  // comment
  return std::move(bytes_);
}

}  // namespace vmesh::io

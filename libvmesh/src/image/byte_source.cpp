#include "byte_source.h"

#include <algorithm>
#include <array>
#include <limits>
#include <new>

#include <zlib.h>

namespace vmesh::image {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16;

}  // namespace

std::size_t BytesInMemory::read(std::span<char> bytes) {
  const std::size_t count = rest_.copy(bytes.data(), bytes.size());
  rest_.remove_prefix(count);
  return count;
}

struct UnpackedBytes::Stream {
  explicit Stream(ByteSource& from) : packed(from) {
    if (inflateInit2(&zlib, 15 + 32) != Z_OK) throw std::bad_alloc();  // 32: detects zlib or gzip
  }
  ~Stream() { inflateEnd(&zlib); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  ByteSource& packed;
  z_stream zlib{};
  int state = Z_OK;
  std::array<char, kBlock> input;
};

UnpackedBytes::UnpackedBytes(ByteSource& packed) : stream_(std::make_unique<Stream>(packed)) {}

UnpackedBytes::~UnpackedBytes() = default;

std::size_t UnpackedBytes::read(std::span<char> bytes) {
  z_stream& zlib = stream_->zlib;
  std::size_t done = 0;
  while (done < bytes.size() && stream_->state == Z_OK) {
    if (zlib.avail_in == 0) {
      zlib.next_in = reinterpret_cast<Bytef*>(stream_->input.data());
      zlib.avail_in = static_cast<uInt>(stream_->packed.read(stream_->input));
    }
    const std::size_t room = std::min<std::size_t>(bytes.size() - done, std::numeric_limits<uInt>::max());
    zlib.next_out = reinterpret_cast<Bytef*>(bytes.data() + done);
    zlib.avail_out = static_cast<uInt>(room);
    stream_->state = inflate(&zlib, Z_NO_FLUSH);  // Z_BUF_ERROR at the end of the input
    done += room - zlib.avail_out;
  }
  return done;
}

std::string_view PeekedBytes::peek(std::size_t count) {
  while (seen_.size() < count) {
    const std::size_t before = seen_.size(), more = std::min(count - before, kBlock);
    seen_.resize(before + more);
    const std::size_t got = source_.read(std::span(seen_).subspan(before));
    seen_.resize(before + got);
    if (got < more) break;
  }
  return std::string_view(seen_).substr(0, count);
}

std::size_t PeekedBytes::read(std::span<char> bytes) {
  const std::size_t count = std::min(bytes.size(), seen_.size() - read_);
  seen_.copy(bytes.data(), count, read_);
  read_ += count;
  if (read_ == seen_.size()) {
    seen_ = std::string();  // its memory is not needed any more
    read_ = 0;
  }
  return count == bytes.size() ? count : count + source_.read(bytes.subspan(count));
}

void skip(ByteSource& source, std::uint64_t count) {
  std::array<char, kBlock> block;
  while (count > 0) {
    const std::size_t step = static_cast<std::size_t>(std::min<std::uint64_t>(count, block.size()));
    if (source.read(std::span(block).first(step)) < step) return;
    count -= step;
  }
}

}  // namespace vmesh::image

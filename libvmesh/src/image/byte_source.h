// Bytes that are read once, from the first to the last, internal to the module: of a file, in memory, uncompressed.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "vmesh/core/input_file.h"

namespace vmesh::image {

class ByteSource {
 public:
  ByteSource() = default;
  virtual ~ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// Reads the next bytes, as many as fit or remain; returns their number.
  virtual std::size_t read(std::span<char> bytes) = 0;
};

class BytesInMemory final : public ByteSource {
 public:
  explicit BytesInMemory(std::string_view bytes) : rest_(bytes) {}
  std::size_t read(std::span<char> bytes) override;

 private:
  std::string_view rest_;
};

/// Throws ReadError like InputFile.
class BytesOfFile final : public ByteSource {
 public:
  explicit BytesOfFile(InputFile& file) : file_(file) {}
  std::size_t read(std::span<char> bytes) override { return file_.read(bytes); }

 private:
  InputFile& file_;
};

/// What zlib or gzip made the bytes of `packed` from. Ends early where these end or are damaged.
class UnpackedBytes final : public ByteSource {
 public:
  explicit UnpackedBytes(ByteSource& packed);
  ~UnpackedBytes() override;
  std::size_t read(std::span<char> bytes) override;

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

/// The same bytes as `source`, of which the first may be looked at before they are read.
class PeekedBytes final : public ByteSource {
 public:
  explicit PeekedBytes(ByteSource& source) : source_(source) {}

  /// The first `count` bytes, or all if there are fewer. Valid until the next call; only before anything is read.
  std::string_view peek(std::size_t count);
  std::size_t read(std::span<char> bytes) override;

 private:
  ByteSource& source_;
  std::string seen_;
  std::size_t read_ = 0;  ///< of the bytes seen
};

/// Reads on without storing, past `count` bytes or to the end.
void skip(ByteSource& source, std::uint64_t count);

}  // namespace vmesh::image

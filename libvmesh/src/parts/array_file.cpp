#include "parts/array_file.h"

#include <algorithm>
#include <array>
#include <bit>

#include <zlib.h>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"

namespace vmesh {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they are in memory");

constexpr std::string_view kMagic = "vmesh arrays 1\n";
constexpr std::size_t kAligned = 8;
constexpr std::uint64_t kLongestHeader = std::uint64_t{1} << 30;

std::size_t aligned(std::size_t size) { return (size + kAligned - 1) / kAligned * kAligned; }

// Continues the checksum. For zero bytes zlib may start a new one.
std::uint32_t sum(std::uint32_t crc, std::span<const std::byte> bytes) {
  if (bytes.empty()) return crc;
  return static_cast<std::uint32_t>(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::uint32_t sum_of_header(const nlohmann::json& header) {
  nlohmann::json without = header;
  without.erase("crc32");
  const std::string text = without.dump();
  return sum(0, std::as_bytes(std::span(text)));
}

std::size_t size_of(const std::string& type) { return type == "f8" ? 8 : type == "u4" ? 4 : type == "u1" ? 1 : 0; }

}  // namespace

void ArrayWriter::add(const std::string& name, const char* type, std::span<const std::byte> bytes, std::size_t size) {
  list_.push_back({{"name", name}, {"type", type}, {"count", bytes.size() / size}, {"offset", 0}});
  arrays_.push_back(bytes);
}

void ArrayWriter::write(const std::filesystem::path& path) {
  // Offsets are relative to the first array, so they do not depend on the header's length.
  std::size_t offset = 0;
  for (std::size_t i = 0; i < arrays_.size(); ++i) {
    list_[i]["offset"] = offset;
    offset += aligned(arrays_[i].size());
  }
  header_["arrays"] = list_;
  std::uint32_t crc = sum_of_header(header_);
  constexpr std::array<std::byte, kAligned> kPadding{};
  const auto padding = [&](std::span<const std::byte> bytes) {
    return std::span(kPadding).first(aligned(bytes.size()) - bytes.size());
  };
  for (const auto& bytes : arrays_) crc = sum(sum(crc, bytes), padding(bytes));
  header_["crc32"] = crc;
  std::string header = header_.dump();
  header.resize(aligned(kMagic.size() + 8 + header.size()) - kMagic.size() - 8, ' ');
  const auto length = std::bit_cast<std::array<char, 8>>(static_cast<std::uint64_t>(header.size()));
  AtomicFile file(path);
  file.write(kMagic);
  file.write({length.data(), length.size()});
  file.write(header);
  for (const auto& bytes : arrays_) {
    file.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    file.write(std::string(padding(bytes).size(), '\0'));
  }
  file.commit();
}

ArrayFile::ArrayFile(const std::filesystem::path& path, const std::string& schema)
    : name_(path.string()), file_(path, std::ios::binary) {
  std::error_code error;
  size_ = std::filesystem::file_size(path, error);
  if (!file_ || error) throw ReadError(name_ + ": cannot be read; is it a file that vmesh split or generate wrote?");
  std::string magic(kMagic.size(), '\0');
  std::uint64_t length = 0;
  if (size_ < kMagic.size() + 8) refuse("is not part of a surface: it is too short");
  read_bytes(0, std::as_writable_bytes(std::span(magic)));
  if (magic != kMagic) refuse("is not part of a surface; vmesh split writes those");
  read_bytes(kMagic.size(), std::as_writable_bytes(std::span(&length, 1)));
  const std::uint64_t first = kMagic.size() + 8;
  first_ = first + length;
  if (length > kLongestHeader || length > size_ - first) refuse("is cut off or damaged: its header ends early");
  std::string header(length, '\0');
  read_bytes(first, std::as_writable_bytes(std::span(header)));
  header_ = nlohmann::json::parse(header, nullptr, false);
  if (!header_.is_object() || header_.value("schema", std::string()) != schema)
    refuse("is not \"" + schema + "\", which is expected here");
  const auto list = header_.find("arrays");
  if (list == header_.end() || !list->is_array()) refuse("is damaged: it lists no arrays");
  for (const auto& entry : *list) {
    Array array;
    try {
      array = {entry.at("name").get<std::string>(), entry.at("type").get<std::string>(),
               entry.at("count").get<std::size_t>(), entry.at("offset").get<std::size_t>()};
    } catch (const nlohmann::json::exception&) {
      refuse("is damaged: its list of arrays cannot be read");
    }
    array.offset += first + length;
    const std::size_t size = size_of(array.type);
    if (size == 0 || array.offset > size_ || array.offset < first + length ||
        array.count > (size_ - array.offset) / size)
      refuse("is cut off or damaged at the array " + array.name);
    arrays_.push_back(std::move(array));
  }
}

void ArrayFile::refuse(const std::string& what) const { throw InvalidInput(name_ + ": " + what); }

const ArrayFile::Array& ArrayFile::find(const std::string& name) const {
  for (const Array& array : arrays_) {
    if (array.name == name) return array;
  }
  refuse("is damaged: it has no array " + name);
}

void ArrayFile::read_bytes(std::size_t offset, std::span<std::byte> bytes) {
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(offset));
  file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file_) throw ReadError(name_ + ": cannot be read to its end");
}

void ArrayFile::read_array(const std::string& name, const char* type, std::size_t first, std::span<std::byte> bytes,
                           std::size_t size) {
  const Array& array = find(name);
  if (array.type != type) refuse("is damaged: the array " + name + " is of another type");
  if (first > array.count || bytes.size() / size > array.count - first)
    refuse("is damaged: the array " + name + " is too short");
  if (!bytes.empty()) read_bytes(array.offset + first * size, bytes);
}

void ArrayFile::read(const std::string& array, std::vector<Vec3>& points) {
  points.resize(count(array) / 3);
  if (points.empty()) return;
  read_array(array, "f8", 0, std::as_writable_bytes(std::span(points.front().data(), 3 * points.size())), 8);
}

void ArrayFile::verify() {
  const auto written = header_.find("crc32");
  require(written != header_.end() && written->is_number_unsigned(), "is damaged: it has no check sum");
  std::uint32_t crc = sum_of_header(header_);
  std::vector<std::byte> block(std::size_t{1} << 20);
  for (std::uint64_t at = first_; at < size_; at += block.size()) {
    block.resize(std::min<std::uint64_t>(block.size(), size_ - at));
    read_bytes(at, block);
    crc = sum(crc, block);
  }
  require(crc == written->get<std::uint64_t>(), "is damaged: its check sum is another; make it again");
}

}  // namespace vmesh

#include "vtp_arrays.h"

#include <algorithm>
#include <array>

#include <zlib.h>

#include "vmesh/core/stored_number.h"

#include "bytes.h"
#include "text.h"

namespace vmesh::io {
namespace {

constexpr std::string_view kBlank = " \t\r\n\v\f";
constexpr std::uint64_t kBestRatio = 1032;  // zlib's largest compression ratio

std::optional<NumberType> type_of(std::string_view name) {
  static constexpr std::array<std::string_view, 10> kNames = {"Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
                                                              "UInt32", "Int64", "UInt64", "Float32", "Float64"};
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<NumberType>(found - kNames.begin());
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

/// Takes up to `count` bytes off the front of `stored`, fewer at its end; in base64, whole groups of four digits, of
/// which a padded one is the last.
std::string take(std::string_view& stored, bool base64, std::uint64_t count) {
  if (!base64) {
    const std::string_view taken =
        stored.substr(0, static_cast<std::size_t>(std::min<std::uint64_t>(count, stored.size())));
    stored.remove_prefix(taken.size());
    return std::string(taken);
  }
  std::string result;
  while (result.size() < count && stored.size() >= 4) {
    std::uint32_t group = 0;
    int digits = 0;
    for (; digits < 4 && base64_digit(stored[static_cast<std::size_t>(digits)]) >= 0; ++digits)
      group = group << 6 | static_cast<std::uint32_t>(base64_digit(stored[static_cast<std::size_t>(digits)]));
    if (digits < 2) break;
    group <<= 6 * (4 - digits);
    for (int byte = 0; byte < digits - 1; ++byte) result += static_cast<char>(group >> (16 - 8 * byte) & 0xff);
    stored.remove_prefix(4);
    if (digits < 4) break;
  }
  if (result.size() > count) result.resize(static_cast<std::size_t>(count));
  return result;
}

std::string_view without_blank_ends(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
  return text.substr(0, text.find_last_not_of(kBlank) + 1);
}

}  // namespace

VtpArrays::VtpArrays(const XmlFile& file, const std::string& source)
    : file_(file), source_(source), appended_left_(file.appended.size()) {
  const pugi::xml_node root = file.document.document_element();
  const auto is = [](pugi::xml_attribute attribute, std::string_view value) { return attribute.value() == value; };
  raw_appended_ = is(root.child("AppendedData").attribute("encoding"), "raw");
  big_endian_ = is(root.attribute("byte_order"), "BigEndian");
  word_size_ = is(root.attribute("header_type"), "UInt64") ? 8 : 4;
  const std::string_view compressor = root.attribute("compressor").value();
  packed_ = !compressor.empty();
  if (packed_ && compressor != "vtkZLibDataCompressor") {
    throw Unsupported(source + ": compressed by " + cite(compressor) + "; save it with zlib, or uncompressed");
  }
}

void VtpArrays::fail(pugi::xml_node array, const std::string& what) const {
  const std::string_view name = array.attribute("Name").value();
  throw InvalidInput(source_ + ": DataArray " + (name.empty() ? "without a name" : cite(name)) + ": " + what);
}

std::uint64_t VtpArrays::header_word(std::string_view bytes, std::size_t i) const {
  const char* at = bytes.data() + i * word_size_;
  return word_size_ == 8 ? load<std::uint64_t>(at, big_endian_) : load<std::uint32_t>(at, big_endian_);
}

/// The appended data from the array's offset on.
std::string_view VtpArrays::appended(pugi::xml_node array) const {
  const std::size_t begin = file_.appended.find_first_not_of(kBlank);
  if (begin == std::string_view::npos || file_.appended[begin] != '_') fail(array, "there is no appended data");
  const std::string_view all = file_.appended.substr(begin + 1);
  const auto offset = parse_integer(array.attribute("offset").value());
  if (!offset || *offset < 0 || static_cast<std::uint64_t>(*offset) > all.size())
    fail(array, "its offset " + cite(array.attribute("offset").value()) + " is beyond the appended data");
  return all.substr(static_cast<std::size_t>(*offset));
}

/// Up to `most` bytes of a binary or appended array; fewer if the file ends. Arrays must not share appended data, or a
/// small file could grow without bound.
std::string VtpArrays::bytes(pugi::xml_node array, std::uint64_t most) {
  const bool is_appended = array.attribute("format").value() == std::string_view("appended");
  const bool base64 = !is_appended || !raw_appended_;
  std::string_view stored = is_appended ? appended(array) : without_blank_ends(array.child_value());
  const std::size_t size = stored.size();
  std::string result = packed_ ? unpacked(array, stored, base64, most) : plain(array, stored, base64, most);
  if (is_appended) {
    const std::uint64_t taken = size - stored.size();
    if (taken > appended_left_) fail(array, "its data overlap those of other arrays");
    appended_left_ -= taken;
  }
  return result;
}

/// The number of bytes, then the bytes.
std::string VtpArrays::plain(pugi::xml_node array, std::string_view& stored, bool base64, std::uint64_t most) const {
  std::string_view peeked = stored;  // size and data are encoded together
  const std::string header = take(peeked, base64, word_size_);
  if (header.size() < word_size_) return {};
  const std::uint64_t size = header_word(header, 0);
  if (size > stored.size()) fail(array, "it should have " + std::to_string(size) + " bytes, which are not there");
  std::string all = take(stored, base64, word_size_ + std::min(size, most));
  return all.erase(0, word_size_);
}

/// Compressed data start with the number of blocks, their size, the size of the last one if it is less, and their
/// compressed sizes.
std::string VtpArrays::unpacked(pugi::xml_node array, std::string_view& stored, bool base64, std::uint64_t most) const {
  std::string_view peeked = stored;
  const std::string first = take(peeked, base64, word_size_);
  if (first.size() < word_size_) return {};
  const std::uint64_t blocks = header_word(first, 0);
  if (blocks > stored.size() / word_size_) fail(array, std::to_string(blocks) + " blocks do not fit into the file");
  const std::string header = take(stored, base64, (3 + blocks) * word_size_);
  if (header.size() < (3 + blocks) * word_size_) fail(array, "the file ends within its header");
  const std::uint64_t block_size = header_word(header, 1), last_size = header_word(header, 2);
  std::uint64_t packed_size = 0;
  for (std::size_t b = 0; b < blocks; ++b)
    packed_size += std::min<std::uint64_t>(header_word(header, 3 + b), stored.size() + 1);
  if (packed_size > stored.size()) fail(array, "its compressed data are longer than the file");
  const std::string packed = take(stored, base64, packed_size);
  std::string result;
  std::size_t at = 0;
  for (std::size_t b = 0; b < blocks && result.size() < most; ++b) {
    const std::uint64_t size = header_word(header, 3 + b);
    const std::uint64_t unpacked_size = b + 1 == blocks && last_size > 0 ? last_size : block_size;
    if (size > packed.size() - at || unpacked_size > size * kBestRatio) fail(array, "a compressed block is too short");
    const std::size_t begin = result.size();
    result.resize(begin + static_cast<std::size_t>(unpacked_size));
    uLongf length = static_cast<uLongf>(unpacked_size);
    const int state = uncompress(reinterpret_cast<Bytef*>(result.data() + begin), &length,
                                 reinterpret_cast<const Bytef*>(packed.data() + at), static_cast<uLong>(size));
    if (state != Z_OK || length != unpacked_size) fail(array, "a compressed block is damaged");
    at += static_cast<std::size_t>(size);
  }
  return result;
}

std::vector<double> VtpArrays::words(pugi::xml_node array, std::uint64_t count) const {
  std::vector<double> values;
  std::string_view text = array.child_value();
  while (values.size() < count) {
    const std::size_t begin = text.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(text.find_first_of(kBlank, begin), text.size());
    const auto value = parse_double(text.substr(begin, end - begin));
    if (!value) fail(array, cite(text.substr(begin, end - begin)) + " is not a number");
    values.push_back(*value);
    text.remove_prefix(end);
  }
  return values;
}

std::vector<double> VtpArrays::numbers(pugi::xml_node array, std::uint64_t count) {
  const auto type = type_of(array.attribute("type").value());
  if (!type) fail(array, "its type " + cite(array.attribute("type").value()) + " holds no numbers that can be read");
  const std::string_view format = array.attribute("format").value();
  std::vector<double> values;
  if (format == "binary" || format == "appended") {
    const std::size_t size = size_of(*type);
    const std::string data = bytes(array, count < kAll / size ? count * size : kAll);
    values.resize(static_cast<std::size_t>(std::min<std::uint64_t>(count, data.size() / size)));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = number_at(data.data() + i * size, *type, big_endian_);
  } else {
    values = words(array, count);
  }
  if (count != kAll && values.size() < count) {
    fail(array, "it holds " + std::to_string(values.size()) + " numbers, there should be " + std::to_string(count) +
                    "; the file is cut off or broken");
  }
  return values;
}

/// Up to `most` bytes of texts; what is no ASCII ends a text.
std::string VtpArrays::characters(pugi::xml_node array, std::uint64_t most) {
  const std::string_view format = array.attribute("format").value();
  if (format == "binary" || format == "appended") return bytes(array, most);
  std::string result;
  for (const double code : words(array, most)) result += code > 0 && code < 128 ? static_cast<char>(code) : '\0';
  return result;
}

std::string VtpArrays::text(pugi::xml_node array) {
  constexpr std::uint64_t kLongest = 256;
  const std::string result = characters(array, kLongest);
  return result.substr(0, result.find('\0'));
}

std::vector<std::string> VtpArrays::texts(pugi::xml_node array) {
  std::vector<std::string> result;
  std::string all = characters(array, kAll);
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find('\0', begin), all.size());
    result.push_back(all.substr(begin, end - begin));
    begin = end + 1;
  }
  return result;
}

}  // namespace vmesh::io

#include "unpack.h"

namespace vmesh::testing {

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  return bytes;
}

std::vector<std::int64_t> unpack(const std::string& text, std::size_t stride) {
  std::vector<std::int64_t> numbers;
  std::uint64_t value = 0;
  int shift = 0;
  for (const char c : from_base64(text)) {
    const auto byte = static_cast<unsigned char>(c);
    value |= static_cast<std::uint64_t>(byte & 127) << shift;
    shift += 7;
    if (byte > 127) continue;
    const auto half = static_cast<std::int64_t>(value >> 1);
    const std::int64_t difference = value % 2 == 0 ? half : -half - 1;
    const std::size_t i = numbers.size();
    numbers.push_back(difference + (i < stride ? 0 : numbers[i - stride]));
    value = 0;
    shift = 0;
  }
  return numbers;
}

}  // namespace vmesh::testing

// Numbers in binary files. Without Eigen, as ITK brings its own.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace vmesh {

enum class NumberType { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

/// Returns what `visit` returns for the number 0 of that type.
template <class Visit>
auto with_type(NumberType type, Visit visit) {
  switch (type) {
    case NumberType::i8:
      return visit(std::int8_t{});
    case NumberType::u8:
      return visit(std::uint8_t{});
    case NumberType::i16:
      return visit(std::int16_t{});
    case NumberType::u16:
      return visit(std::uint16_t{});
    case NumberType::i32:
      return visit(std::int32_t{});
    case NumberType::u32:
      return visit(std::uint32_t{});
    case NumberType::i64:
      return visit(std::int64_t{});
    case NumberType::u64:
      return visit(std::uint64_t{});
    case NumberType::f32:
      return visit(float{});
    case NumberType::f64:
      break;
  }
  return visit(double{});
}

inline std::size_t size_of(NumberType type) {
  return with_type(type, [](auto number) { return sizeof number; });
}

inline bool is_integer(NumberType type) { return type != NumberType::f32 && type != NumberType::f64; }

/// The number of type T at `bytes` in little-endian (or big-endian) order.
template <class T>
T load(const char* bytes, bool big_endian = false) {
  std::array<char, sizeof(T)> buffer;
  std::memcpy(buffer.data(), bytes, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(buffer.begin(), buffer.end());
  return std::bit_cast<T>(buffer);
}

/// The number of that type at `bytes`; integers beyond 2^53 are rounded.
inline double number_at(const char* bytes, NumberType type, bool big_endian) {
  return with_type(type, [&](auto number) { return static_cast<double>(load<decltype(number)>(bytes, big_endian)); });
}

}  // namespace vmesh

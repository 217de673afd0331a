#include "number_type.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "vmesh/core/error.h"

namespace vmesh::image {
namespace {

template <class T>
T number_at(const char* bytes, bool big_endian) {
  std::array<char, sizeof(T)> buffer;
  std::memcpy(buffer.data(), bytes, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(buffer.begin(), buffer.end());
  return std::bit_cast<T>(buffer);
}

/// Labels that change in float would be confused.
void check_exact(double stored, float number, const std::string& name) {
  if (static_cast<double>(number) != stored)
    throw Unsupported(name + ": contains the integer " + std::to_string(stored) +
                      "; those above 16777216 cannot be told apart. Renumber the labels");
}

/// Integers that float represents, all of them.
template <class T>
constexpr bool kAlwaysExact = std::numeric_limits<T>::is_integer && sizeof(T) <= 2;

template <class T>
void read_exact(std::string_view bytes, bool big_endian, std::span<float> values) {
  for (std::size_t n = 0; n < values.size(); ++n)
    values[n] = static_cast<float>(number_at<T>(bytes.data() + n * sizeof(T), big_endian));
}

template <class T>
void read_numbers_of(std::string_view bytes, const StoredNumbers& numbers, std::span<float> values,
                     const std::string& name, std::size_t first) {
  const bool scaled = numbers.slope != 1 || numbers.intercept != 0;
  if (kAlwaysExact<T> && !scaled) return read_exact<T>(bytes, numbers.big_endian, values);
  for (std::size_t n = 0; n < values.size(); ++n) {
    const auto stored = static_cast<double>(number_at<T>(bytes.data() + n * sizeof(T), numbers.big_endian));
    const auto number = static_cast<float>(scaled ? numbers.slope * stored + numbers.intercept : stored);
    if (!std::isfinite(number))
      throw InvalidInput(name + ": voxel " + std::to_string(first + n) +
                         ", counted from 0 as stored, has no finite value; repair or mask it");
    if (std::numeric_limits<T>::is_integer && !scaled) check_exact(stored, number, name);
    values[n] = number;
  }
}

}  // namespace

std::size_t bytes_of(NumberType type) {
  switch (type) {
    case NumberType::u8:
    case NumberType::i8:
      return 1;
    case NumberType::u16:
    case NumberType::i16:
      return 2;
    case NumberType::u32:
    case NumberType::i32:
    case NumberType::f32:
      return 4;
    case NumberType::u64:
    case NumberType::i64:
    case NumberType::f64:
      return 8;
  }
  return 1;
}

bool is_integer(NumberType type) { return type != NumberType::f32 && type != NumberType::f64; }

void read_numbers(std::string_view bytes, const StoredNumbers& stored, std::span<float> values, const std::string& name,
                  std::size_t first) {
  switch (stored.type) {
    case NumberType::u8:
      return read_numbers_of<std::uint8_t>(bytes, stored, values, name, first);
    case NumberType::i8:
      return read_numbers_of<std::int8_t>(bytes, stored, values, name, first);
    case NumberType::u16:
      return read_numbers_of<std::uint16_t>(bytes, stored, values, name, first);
    case NumberType::i16:
      return read_numbers_of<std::int16_t>(bytes, stored, values, name, first);
    case NumberType::u32:
      return read_numbers_of<std::uint32_t>(bytes, stored, values, name, first);
    case NumberType::i32:
      return read_numbers_of<std::int32_t>(bytes, stored, values, name, first);
    case NumberType::u64:
      return read_numbers_of<std::uint64_t>(bytes, stored, values, name, first);
    case NumberType::i64:
      return read_numbers_of<std::int64_t>(bytes, stored, values, name, first);
    case NumberType::f32:
      return read_numbers_of<float>(bytes, stored, values, name, first);
    case NumberType::f64:
      return read_numbers_of<double>(bytes, stored, values, name, first);
  }
}

}  // namespace vmesh::image

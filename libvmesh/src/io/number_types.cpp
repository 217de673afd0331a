#include "number_types.h"

#include <array>
#include <cstdint>

#include "bytes.h"

namespace vmesh::io {

std::size_t size_of(NumberType type) {
  constexpr std::array<std::size_t, 10> kSizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

double number_at(const char* bytes, NumberType type, bool big_endian) {
  switch (type) {
    case NumberType::int8:
      return load<std::int8_t>(bytes);
    case NumberType::uint8:
      return load<std::uint8_t>(bytes);
    case NumberType::int16:
      return load<std::int16_t>(bytes, big_endian);
    case NumberType::uint16:
      return load<std::uint16_t>(bytes, big_endian);
    case NumberType::int32:
      return load<std::int32_t>(bytes, big_endian);
    case NumberType::uint32:
      return load<std::uint32_t>(bytes, big_endian);
    case NumberType::int64:
      return static_cast<double>(load<std::int64_t>(bytes, big_endian));
    case NumberType::uint64:
      return static_cast<double>(load<std::uint64_t>(bytes, big_endian));
    case NumberType::float32:
      return load<float>(bytes, big_endian);
    case NumberType::float64:
      return load<double>(bytes, big_endian);
  }
  return 0;
}

}  // namespace vmesh::io

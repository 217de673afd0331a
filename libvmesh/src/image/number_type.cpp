#include "number_type.h"

#include <cmath>
#include <limits>

#include "vmesh/core/error.h"

namespace vmesh::image {
namespace {

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
    values[n] = static_cast<float>(load<T>(bytes.data() + n * sizeof(T), big_endian));
}

template <class T>
void read_numbers_of(std::string_view bytes, const StoredNumbers& numbers, std::span<float> values,
                     const std::string& name, std::size_t first) {
  const bool scaled = numbers.slope != 1 || numbers.intercept != 0;
  if (kAlwaysExact<T> && !scaled) return read_exact<T>(bytes, numbers.big_endian, values);
  for (std::size_t n = 0; n < values.size(); ++n) {
    const auto stored = static_cast<double>(load<T>(bytes.data() + n * sizeof(T), numbers.big_endian));
    const auto number = static_cast<float>(scaled ? numbers.slope * stored + numbers.intercept : stored);
    if (!std::isfinite(number))
      throw InvalidInput(name + ": voxel " + std::to_string(first + n) +
                         ", counted from 0 as stored, has no finite value; repair or mask it");
    if (std::numeric_limits<T>::is_integer && !scaled) check_exact(stored, number, name);
    values[n] = number;
  }
}

}  // namespace

void read_numbers(std::string_view bytes, const StoredNumbers& stored, std::span<float> values, const std::string& name,
                  std::size_t first) {
  with_type(stored.type, [&](auto number) { read_numbers_of<decltype(number)>(bytes, stored, values, name, first); });
}

}  // namespace vmesh::image

// Kinds of numbers in binary files, internal to the module.
#pragma once

#include <cstddef>

namespace vmesh::io {

enum class NumberType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Size in bytes.
std::size_t size_of(NumberType type);

/// The number at `bytes`; integers beyond 2^53 are rounded.
double number_at(const char* bytes, NumberType type, bool big_endian);

}  // namespace vmesh::io

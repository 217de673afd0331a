// The codecs of EXT_meshopt_compression, by meshoptimizer; internal to the module. Only in builds with it.
#pragma once

#include <string>
#include <string_view>

namespace vmesh::io {

/// Numbers of 32 bits as the filter EXPONENTIAL stores them: of every `stride` bytes, the greatest number is rounded to
/// `bits` binary digits and its sign, the others to the same step.
std::string with_exponents(std::string_view floats, std::size_t stride, int bits);
/// What programs get back.
std::string without_exponents(std::string stored, std::size_t stride);

/// In the mode ATTRIBUTES, for values of `stride` bytes.
std::string packed_values(std::string_view bytes, std::size_t stride);

/// In the mode TRIANGLES: their order, and which corner comes first, may change. Indices are below `vertices`.
std::string packed_triangles(std::string_view indices, std::size_t vertices);

}  // namespace vmesh::io

#include "glb_packing.h"

#include <cstring>
#include <vector>

#include <meshoptimizer.h>

namespace vmesh::io {
namespace {

/// The versions of the codecs that the extension's specification asks for.
void choose_versions() {
  static const bool kChosen = [] {
    meshopt_encodeVertexVersion(0);
    meshopt_encodeIndexVersion(1);
    return true;
  }();
  static_cast<void>(kChosen);
}

template <class Number>
std::vector<Number> numbers_of(std::string_view bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}

/// What `encode(buffer, size)` writes of at most `bound` bytes.
template <class Encode>
std::string encoded(std::size_t bound, Encode encode) {
  std::vector<unsigned char> buffer(bound);
  buffer.resize(encode(buffer.data(), buffer.size()));
  return {buffer.begin(), buffer.end()};
}

}  // namespace

std::string with_exponents(std::string_view floats, std::size_t stride, int bits) {
  const std::vector<float> numbers = numbers_of<float>(floats);
  std::string stored(floats.size(), '\0');
#if MESHOPTIMIZER_VERSION >= 190
  meshopt_encodeFilterExp(stored.data(), floats.size() / stride, stride, bits, numbers.data(),
                          meshopt_EncodeExpSharedVector);
#else
  meshopt_encodeFilterExp(stored.data(), floats.size() / stride, stride, bits, numbers.data());
#endif
  return stored;
}

std::string without_exponents(std::string stored, std::size_t stride) {
  meshopt_decodeFilterExp(stored.data(), stored.size() / stride, stride);
  return stored;
}

std::string packed_values(std::string_view bytes, std::size_t stride) {
  choose_versions();
  const std::size_t count = bytes.size() / stride;
  return encoded(meshopt_encodeVertexBufferBound(count, stride), [&](unsigned char* buffer, std::size_t size) {
    return meshopt_encodeVertexBuffer(buffer, size, bytes.data(), count, stride);
  });
}

std::string packed_triangles(std::string_view indices, std::size_t vertices) {
  choose_versions();
  const std::vector<unsigned int> given = numbers_of<unsigned int>(indices);
  std::vector<unsigned int> ordered(given.size());
  meshopt_optimizeVertexCacheStrip(ordered.data(), given.data(), given.size(), vertices);
  return encoded(meshopt_encodeIndexBufferBound(given.size(), vertices), [&](unsigned char* buffer, std::size_t size) {
    return meshopt_encodeIndexBuffer(buffer, size, ordered.data(), ordered.size());
  });
}

}  // namespace vmesh::io

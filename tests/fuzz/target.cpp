// The entry point of a libFuzzer program for the reader VMESH_FUZZ_READER.
#include <cstdint>

#include "readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const vmesh::testing::Reader& reader = vmesh::testing::reader_named(VMESH_FUZZ_READER);
  reader.read({reinterpret_cast<const char*>(data), size});
  return 0;
}

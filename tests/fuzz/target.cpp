// The entry point of libFuzzer, for the reader that the environment variable VMESH_FUZZ_READER names.
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

#include "readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

const vmesh::testing::Reader& chosen_reader() {
  const char* name = std::getenv("VMESH_FUZZ_READER");
  if (name == nullptr) throw std::invalid_argument("VMESH_FUZZ_READER is not set");
  return vmesh::testing::reader_named(name);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const vmesh::testing::Reader& reader = chosen_reader();
  reader.read({reinterpret_cast<const char*>(data), size});
  return 0;
}

// Replaces hdf5_reader.cpp in a build without HDF5.
#include "vmesh/core/error.h"

#include "formats.h"

namespace vmesh::io {

RawCenterline read_hdf5_network(const std::filesystem::path& path) {
  throw Unsupported(path.string() +
                    ": reading .h5 needs HDF5 and this vmesh was built without it (CMake option VMESH_WITH_HDF5); "
                    "convert the network to .vmv or .vtp");
}

}  // namespace vmesh::io

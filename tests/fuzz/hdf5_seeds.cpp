// HDF5 files, made in memory.
#include <vector>

#include <hdf5.h>

#include "seeds.h"

namespace vmesh::testing {
namespace {

void write_table(hid_t file, const char* name, hsize_t columns, const std::vector<double>& values, hid_t stored_as) {
  const hsize_t size[2] = {values.size() / columns, columns};
  const hid_t space = H5Screate_simple(2, size, nullptr);
  const hid_t data = H5Dcreate2(file, name, stored_as, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(data);
  H5Sclose(space);
}

/// A trunk of three points and two branches of two.
std::string network(bool with_connectivity) {
  constexpr std::size_t kBlock = 4096;
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, kBlock, false);
  const hid_t file = H5Fcreate("seed.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access);
  write_table(file, "points", 4,
              {0, 0, 0, 4, 9, 0, 0, 3, 20, 0, 0, 3, 20, 0, 0, 3, 30, 9, 0, 2, 20, 0, 0, 3, 30, -9, 0, 2},
              H5T_IEEE_F32LE);
  write_table(file, "structure", 2, {0, 0, 3, 0, 5, 0}, H5T_STD_I64LE);
  if (with_connectivity) write_table(file, "connectivity", 2, {0, 1, 0, 2}, H5T_STD_I64LE);
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  std::string image(static_cast<std::size_t>(H5Fget_file_image(file, nullptr, 0)), '\0');
  H5Fget_file_image(file, image.data(), image.size());
  H5Fclose(file);
  H5Pclose(access);
  return image;
}

}  // namespace

std::vector<std::string> hdf5_seeds() { return {network(true), network(false)}; }

}  // namespace vmesh::testing

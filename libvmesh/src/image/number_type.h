// How voxels are stored, internal to the module.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "vmesh/core/stored_number.h"

namespace vmesh::image {

/// How a voxel is stored: value = slope * stored + intercept.
struct StoredNumbers {
  NumberType type = NumberType::u8;
  bool big_endian = false;
  double slope = 1, intercept = 0;
};

/// Reads values.size() numbers from `bytes`, which must contain as many. Throws InvalidInput for numbers that are not
/// finite, Unsupported for integers that float cannot represent; `name` is the file's, `first` the number of voxels
/// before these.
void read_numbers(std::string_view bytes, const StoredNumbers& stored, std::span<float> values, const std::string& name,
                  std::size_t first = 0);

}  // namespace vmesh::image

// ITK has its own Eigen, which cannot be compiled together with ours, so neither may appear here.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace vmesh::testing {

/// Where ITK, and so 3D Slicer, puts an image. LPS, mm.
struct ItkPlace {
  std::array<std::size_t, 3> size{};
  std::array<double, 3> origin{};
  std::array<std::array<double, 3>, 3> steps{};  ///< steps[a]: from one voxel to the next along axis a
};

ItkPlace place_by_itk(const std::string& path);

}  // namespace vmesh::testing

#include "vmesh/reference/sampled_field.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"
#include "vmesh/image/contour.h"

namespace vmesh {
namespace {

constexpr double kBand = 2;                   // voxels on both sides of the boundary
constexpr double kMostVoxels = 2147483648.0;  // 8 GiB of them
using Box = Eigen::AlignedBox3d;

Box box_of(const VesselField& field, Index cone, double margin) {
  Box box;
  for (const Index n : {field.relations().first_node(cone), field.relations().last_node(cone)}) {
    const CenterlineNode& node = field.relations().centerline().node(n);
    box.extend(Box(node.position.array() - (node.radius + margin), node.position.array() + (node.radius + margin)));
  }
  return box;
}

VoxelImage empty_image(const Box& box, double voxel) {
  const Vec3 counts = (box.sizes() / voxel).array().ceil() + 1;
  if (!(counts.prod() <= kMostVoxels))
    throw InvalidInput("voxels of " + std::to_string(voxel) +
                       " mm are too small for this centerline: more than 2^31 of them; choose larger ones");
  require_memory(counts.prod() * (sizeof(float) + kContourBytesPerVoxel),
                 "an image with voxels of " + std::to_string(voxel) + " mm", "choose larger ones");
  VoxelImage image;
  for (int a = 0; a < 3; ++a) image.size[a] = static_cast<std::size_t>(counts[a]);
  image.origin = box.min();
  image.steps *= voxel;
  image.values.assign(image.size[0] * image.size[1] * image.size[2], static_cast<float>(-kBand * voxel));
  return image;
}

/// Raises the values around `cone` to its own.
void add_cone(VoxelImage& image, const VesselField& field, Index cone, double voxel) {
  const Box box = box_of(field, cone, kBand * voxel);
  std::array<std::size_t, 3> low{}, high{};
  for (int a = 0; a < 3; ++a) {
    low[a] = static_cast<std::size_t>(std::max(0.0, std::floor((box.min()[a] - image.origin[a]) / voxel)));
    high[a] =
        std::min(image.size[a] - 1, static_cast<std::size_t>(std::ceil((box.max()[a] - image.origin[a]) / voxel)));
  }
  const auto most = static_cast<float>(kBand * voxel);
  for (std::size_t k = low[2]; k <= high[2]; ++k) {
    for (std::size_t j = low[1]; j <= high[1]; ++j) {
      for (std::size_t i = low[0]; i <= high[0]; ++i) {
        const Vec3 voxel_index(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        const auto depth = static_cast<float>(-field.sample_cone(image.position(voxel_index), cone).distance);
        float& value = image.values[image.offset(i, j, k)];
        value = std::max(value, std::min(depth, most));
      }
    }
  }
}

}  // namespace

VoxelImage sample_field(const Centerline& centerline, double voxel) {
  if (!(voxel > 0) || !std::isfinite(voxel)) throw InvalidInput("the size of a voxel must be positive");
  const VesselField field(centerline);
  Box box;
  for (Index cone = 0; cone < field.relations().cone_count(); ++cone) box.extend(box_of(field, cone, kBand * voxel));
  VoxelImage image = empty_image(box, voxel);
  for (Index cone = 0; cone < field.relations().cone_count(); ++cone) add_cone(image, field, cone, voxel);
  return image;
}

}  // namespace vmesh

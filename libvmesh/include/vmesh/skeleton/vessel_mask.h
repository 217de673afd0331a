#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vmesh/image/voxel_image.h"
#include "vmesh/reference/reference_surface.h"

namespace vmesh {

namespace skeleton {
struct MaskContent;
}

/// The voxels of vessels in an image, and where between voxels the vessels end. Takes memory by the vessels' voxels,
/// not by the image's.
class VesselMask {
 public:
  /// Which values are inside: see ReferenceOptions::label, labels and threshold. `frame`: size and place of the image;
  /// its values are not used.
  VesselMask(const VoxelImage& frame, const ReferenceOptions& options);
  ~VesselMask();
  VesselMask(VesselMask&&) noexcept;
  VesselMask& operator=(VesselMask&&) noexcept;

  /// The values of slice k of the third axis, the first axis fastest: frame.size[0] * frame.size[1] of them. Slices
  /// come in ascending order.
  void add_slice(std::size_t k, std::span<const float> values);
  /// After the last slice. Throws InvalidInput if there is no voxel inside (naming the values there are), and if
  /// neither label nor threshold are given and there are several values besides 0.
  void finish();

  /// Voxels inside, before cavities and pinholes are filled.
  std::size_t voxel_count() const;

  const skeleton::MaskContent& content() const { return *content_; }
  skeleton::MaskContent& content() { return *content_; }

 private:
  std::unique_ptr<skeleton::MaskContent> content_;
};

/// Of an image file, slice by slice unless it is to be resampled or smoothed first. `warnings`: of reading, appended.
/// Throws what read_image(), prepared_image() and VesselMask throw.
VesselMask read_vessel_mask(const std::filesystem::path& path, const ReferenceOptions& options,
                            std::vector<std::string>& warnings);

/// Of an image in memory.
VesselMask vessel_mask(const LoadedImage& image, const ReferenceOptions& options);

}  // namespace vmesh

#include "formats.h"

namespace vmesh {

const std::vector<VolumeFormat>& volume_formats() {
  static const std::vector<VolumeFormat> formats = {
      {.name = "VTU", .extensions = {".vtu"}, .write = io::write_volume_vtu},
  };
  return formats;
}

}  // namespace vmesh

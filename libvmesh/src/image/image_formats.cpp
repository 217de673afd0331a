#include "vmesh/image/image_io.h"

#include "image_header.h"
#include "tiff.h"

namespace vmesh {
namespace {

#if VMESH_IMAGE_WITH_TIFF
constexpr auto kReadTiff = image::read_tiff;
#else
constexpr decltype(&image::read_tiff) kReadTiff = nullptr;
#endif

}  // namespace

const std::vector<ImageFormat>& image_formats() {
  using namespace image;
  constexpr std::size_t kLongestText = std::size_t{1} << 20, kLongestNifti = 540;
  static const std::vector<ImageFormat> formats = {
      {.name = "NIfTI",
       .extensions = {".nii", ".nii.gz"},
       .header_bytes = kLongestNifti,
       .compressed_whole = true,
       .parse_header = parse_nifti_header},
      {.name = "NIfTI or Analyze in two files",
       .extensions = {".hdr"},
       .of_parts = {".img"},
       .in_two_files = true,
       .header_bytes = kLongestNifti,
       .compressed_whole = true,
       .parse_header = parse_nifti_header},
      {.name = "NRRD", .extensions = {".nrrd"}, .header_bytes = kLongestText, .parse_header = parse_nrrd_header},
      {.name = "NRRD in two files",
       .extensions = {".nhdr"},
       .in_two_files = true,
       .header_bytes = kLongestText,
       .parse_header = parse_nrrd_header},
      {.name = "MetaImage", .extensions = {".mha"}, .header_bytes = kLongestText, .parse_header = parse_meta_header},
      {.name = "MetaImage in two files",
       .extensions = {".mhd"},
       .in_two_files = true,
       .header_bytes = kLongestText,
       .parse_header = parse_meta_header},
      {.name = "TIFF",
       .extensions = {".tif", ".tiff"},
       .options = {"voxel-size"},
       .needs = {"TIFF", ".nii.gz, .nrrd or .mha"},
       .read = kReadTiff},
      {.name = "DICOM", .extensions = {}, .of_parts = {".dcm"}},
  };
  return formats;
}

std::string listed_image_extensions() {
  std::vector<std::string> all = extensions_of(image_formats(), [](const auto&) { return true; });
  all.push_back("a folder of DICOM files");
  return listed(all);
}

}  // namespace vmesh

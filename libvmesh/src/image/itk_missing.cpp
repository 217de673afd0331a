// Replaces read_by_itk.cpp in a build without ITK.
#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"

#include "read_by_itk.h"

namespace vmesh::image {

void read_by_itk(const std::filesystem::path& path, const ImageBegin&, const SliceVisitor&) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) const InputFile there(path);
  throw Unsupported(path.string() +
                    ": reading DICOM, .mhd, .nhdr, .hdr and .img needs ITK and this vmesh was built without ITK (CMake "
                    "option VMESH_WITH_ITK); build it with, or convert the image to .nii.gz, .nrrd or .mha, in 3D "
                    "Slicer say");
}

}  // namespace vmesh::image

// Replaces read_dicom.cpp in a build without GDCM.
#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"

#include "read_dicom.h"

namespace vmesh::image {

void read_dicom(const std::filesystem::path& path, const ImageBegin&, const SliceVisitor&) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) const InputFile there(path);
  throw Unsupported(path.string() +
                    ": reading DICOM needs GDCM and this vmesh was built without GDCM (CMake option "
                    "VMESH_WITH_DICOM); build it with, or convert the image to .nii.gz, .nrrd or .mha, in 3D Slicer "
                    "say");
}

}  // namespace vmesh::image

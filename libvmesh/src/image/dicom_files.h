// Recognises DICOM files without a library; internal to the module.
#pragma once

#include <filesystem>
#include <vector>

namespace vmesh::image {

/// A regular file that starts like a DICOM file, or a folder with one.
bool is_dicom(const std::filesystem::path& path);

/// The DICOM files in a folder except its index (DICOMDIR), in the order of their names. Throws ReadError when the
/// folder cannot be read.
std::vector<std::filesystem::path> dicom_files_in(const std::filesystem::path& folder);

}  // namespace vmesh::image

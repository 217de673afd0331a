// Which files are DICOM, internal to the module; told without a library.
#pragma once

#include <filesystem>
#include <vector>

namespace vmesh::image {

/// A regular file that begins as a DICOM file does, or a folder with one.
bool is_dicom(const std::filesystem::path& path);

/// The DICOM files in a folder, but for its index (DICOMDIR), in the order of their names. Throws ReadError when the
/// folder cannot be read.
std::vector<std::filesystem::path> dicom_files_in(const std::filesystem::path& folder);

}  // namespace vmesh::image

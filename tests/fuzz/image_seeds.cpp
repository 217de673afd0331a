#include "../image/image_files.h"
#include "seeds.h"

namespace vmesh::testing {
namespace {

SampleImage small_image() {
  SampleImage image;
  image.size = {3, 2, 2};
  return image;
}

std::vector<double> small_values() { return {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 200}; }

/// Stored, not compressed, so that a fuzzer can change what is inside.
std::string stored(const std::string& bytes) { return packed(bytes, true, Z_NO_COMPRESSION); }

std::vector<std::string> nii_seeds() {
  const SampleImage image = small_image();
  return {nifti_file<std::int16_t>(image, small_values()), nifti_file<float>(image, small_values(), NiftiPlace::qform),
          nifti_file<std::uint16_t>(image, small_values(), NiftiPlace::sform, true),
          nifti2_file<std::int16_t>(image, small_values())};
}

std::vector<std::string> nii_gz_seeds() {
  std::vector<std::string> files;
  for (const std::string& file : nii_seeds()) {
    files.push_back(packed(file, true));
    files.push_back(stored(file));
  }
  return files;
}

std::vector<std::string> nrrd_seeds() {
  const SampleImage image = small_image();
  const std::string voxels = voxel_bytes<std::int16_t>(small_values());
  return {nrrd_header(image, "short") + voxels,
          nrrd_header(image, "int16", "encoding: gzip\n", true) + packed(voxels, true),
          "NRRD0001\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nspacings: 1 2 3\nencoding: raw\nkey:=value\n\n" +
              voxel_bytes<std::uint8_t>(small_values()),
          layered_nrrd({0, 1, 1, 0, 2, 2, 0, 1, 1, 0, 2, 2}, {0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 1, 0})};
}

std::vector<std::string> mha_seeds() {
  const SampleImage image = small_image();
  const std::string voxels = voxel_bytes<float>(small_values());
  return {mha_header(image, "MET_FLOAT") + voxels,
          mha_header(image, "MET_FLOAT", "CompressedData = True\n") + packed(voxels, false),
          "NDims = 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
              voxel_bytes<std::uint8_t>(small_values())};
}

std::vector<std::string> tif_seeds() {
  return {tiff_file<std::int16_t>(small_image(), small_values(), "ImageJ=1.5\nimages=2\nunit=mm\nspacing=3\n", 2),
          tiff_file<std::uint8_t>(small_image(), small_values(), "", 0, true),
          tiff_file<float>(small_image(), small_values())};
}

}  // namespace

std::map<std::string, MakeSeeds> image_seeds() {
  return {
      {".nii", nii_seeds}, {".nii.gz", nii_gz_seeds}, {".nrrd", nrrd_seeds},
      {".mha", mha_seeds}, {".tif", tif_seeds},       {".tiff", tif_seeds},
  };
}

}  // namespace vmesh::testing

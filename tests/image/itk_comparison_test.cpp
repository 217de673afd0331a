#include <filesystem>

#include <gtest/gtest.h>

#include "vmesh/image/image_io.h"

#include "../io/io_support.h"
#include "image_files.h"
#include "itk_oracle.h"

namespace vmesh::testing {
namespace {

void expect_same_place(const std::filesystem::path& path) {
  const VoxelImage ours = read_image(path).image;
  const ItkPlace itk = place_by_itk(path.string());
  EXPECT_EQ(ours.size, itk.size) << path;
  for (int a = 0; a < 3; ++a) {
    // NIfTI headers hold float.
    EXPECT_NEAR(ours.origin[a], itk.origin[a], 1e-4) << path;
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(ours.steps(b, a), itk.steps[a][b], 1e-6) << path;
  }
}

TEST(ItkComparison, ImagesLieWhereItkPutsThem) {
  const TemporaryFolder folder;
  for (const double handed : {1.0, -1.0}) {
    SampleImage sample;
    sample.direction.col(1) *= handed;
    const std::vector<double> values = sample.values();
    const std::string voxels = voxel_bytes<std::int16_t>(values);
    expect_same_place(folder.write("s.nii", nifti_file<std::int16_t>(sample, values)));
    expect_same_place(folder.write("q.nii", nifti_file<std::int16_t>(sample, values, NiftiPlace::qform)));
    expect_same_place(folder.write("big.nii", nifti_file<std::int16_t>(sample, values, NiftiPlace::qform, true)));
    expect_same_place(folder.write("lps.nrrd", nrrd_header(sample, "short") + voxels));
    expect_same_place(folder.write("ras.nrrd", nrrd_header(sample, "short", "encoding: raw\n", true) + voxels));
    expect_same_place(folder.write("a.mha", mha_header(sample, "MET_SHORT") + voxels));
    folder.write("two.raw", voxels);
    std::string header = mha_header(sample, "MET_SHORT");
    expect_same_place(folder.write("two.mhd", header.replace(header.find("LOCAL"), 5, "two.raw")));
    expect_same_place(folder.write("two.nhdr", nrrd_header(sample, "short", "encoding: raw\ndata file: two.raw\n")));
  }
}

TEST(ItkComparison, NiftiWithoutAPlaceLiesWhereItkPutsIt) {
  const TemporaryFolder folder;
  const SampleImage sample;
  std::string bytes = nifti_file<std::int16_t>(sample, sample.values());
  bytes.replace(254, 2, bytes_of(std::int16_t{0}, false));
  expect_same_place(folder.write("a.nii", bytes));
  folder.write("a.img", bytes.substr(352));
  bytes.replace(108, 4, bytes_of(0.0f, false)).replace(344, 4, std::string("ni1\0", 4));
  expect_same_place(folder.write("a.hdr", bytes.substr(0, 348)));
  // As Analyze, with an orientation.
  bytes.replace(344, 4, std::string(4, '\0'))[252] = 2;
  expect_same_place(folder.write("a.hdr", bytes.substr(0, 348)));
}

TEST(ItkComparison, RealSegmentationsLieWhereItkPutsThem) {
  const std::filesystem::path data = std::filesystem::path(VMESH_SHARED_DATA) / "liver_segmentations";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not there";
  for (const auto& entry : std::filesystem::directory_iterator(data)) expect_same_place(entry.path());
}

}  // namespace
}  // namespace vmesh::testing

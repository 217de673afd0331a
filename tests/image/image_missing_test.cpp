#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/image/image_io.h"

#include "../io/io_support.h"

namespace vmesh::testing {
namespace {

#if !VMESH_HAS_DICOM
TEST(WithoutGdcm, ReadingSaysWhatIsMissing) {
  const TemporaryFolder folder;
  const std::string message = message_of<Unsupported>([&] { read_image(folder.write("a.dcm", "x")); });
  expect_contains(message, "built without GDCM (CMake option VMESH_WITH_DICOM)");
  expect_contains(message, "a.dcm");
  EXPECT_THROW(read_image(folder / "missing.dcm"), ReadError);
}
#endif

#if !VMESH_HAS_TIFF
TEST(WithoutLibtiff, ReadingSaysWhatIsMissing) {
  const TemporaryFolder folder;
  const std::string message = message_of<Unsupported>([&] { read_image(folder.write("a.tif", "x")); });
  expect_contains(message, "built without TIFF (CMake option VMESH_WITH_TIFF)");
  expect_contains(message, "a.tif");
  EXPECT_THROW(read_image(folder / "missing.tif"), ReadError);
}
#endif

TEST(ImagePath, DicomIsToldByItsContent) {
  const TemporaryFolder folder;
  std::string begin(132, '\0');
  begin.replace(128, 4, "DICM");
  EXPECT_FALSE(is_image(folder / ""));
  folder.write("notes", std::string(200, 'x'));
  folder.write("DICOMDIR", begin);
  EXPECT_FALSE(is_image(folder / ""));
  EXPECT_FALSE(is_image(folder / "notes"));
  EXPECT_FALSE(is_image(folder / "missing"));
  EXPECT_TRUE(is_image(folder.write("IM0001", begin)));
  EXPECT_TRUE(is_image(folder / ""));
}

TEST(ImagePath, IsToldByItsEnding) {
  for (const char* name : {"a.nii", "b/a.NII.GZ", "a.nrrd", "A.Mha", "a.mhd", "a.dcm", "a.tif", "a.TIFF"})
    EXPECT_TRUE(is_image_path(name)) << name;
  for (const char* name : {"a.gz", "a.ply", "nii", "a.nii.ply", ""}) EXPECT_FALSE(is_image_path(name)) << name;
}

}  // namespace
}  // namespace vmesh::testing

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/image/contour.h"
#include "vmesh/image/image_io.h"

#include "../io/io_support.h"

namespace vmesh::testing {
namespace {

#if !VMESH_WITH_VTK
TEST(WithoutVtk, ContouringSaysWhatIsMissing) {
  expect_contains(message_of<Unsupported>([] { contour(VoxelImage(), 0.5); }), "VMESH_WITH_VTK");
}
#endif

TEST(ImagePath, IsToldByItsEnding) {
  for (const char* name : {"a.nii", "b/a.NII.GZ", "a.nrrd", "A.Mha"}) EXPECT_TRUE(is_image_path(name)) << name;
  for (const char* name : {"a.gz", "a.ply", "nii", "a.nii.ply", ""}) EXPECT_FALSE(is_image_path(name)) << name;
}

}  // namespace
}  // namespace vmesh::testing

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/render/render.h"

namespace vmesh {
namespace {

TEST(ViewDirectionNames, AreUnderstood) {
  EXPECT_EQ(view_direction("front").azimuth_deg, 0);
  EXPECT_EQ(view_direction("left").azimuth_deg, 90);
  EXPECT_EQ(view_direction("top").elevation_deg, 90);
  EXPECT_NE(view_direction("iso").elevation_deg, 0);
  EXPECT_EQ(view_direction("30,-15.5").azimuth_deg, 30);
  EXPECT_EQ(view_direction("30,-15.5").elevation_deg, -15.5);
}

TEST(ViewDirectionNames, ThatMakeNoSenseAreRejected) {
  for (const char* name : {"", "above", "Front", "30", "30,", ",1", "1,2,3", "nan,0", "1 ,2", "inf,0"}) {
    EXPECT_THROW(view_direction(name), InvalidInput) << name;
  }
}

}  // namespace
}  // namespace vmesh

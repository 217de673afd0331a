#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using Render = CommandTest;

TEST_F(Render, DrawsAPictureOfTheSizeAskedFor) {
  write_y("y.swc");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  const Outcome run = vmesh({"render", "@y.ply", "-o", "@y.png", "--width", "160", "--height", "120"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "");
  const std::string png = read("y.png");
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\0\xa0\0\0\0\x78", 8));
}

TEST_F(Render, ColoursByBranchOrByWhatElseIsInTheFile) {
  write_y("y.swc");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  const auto draw = [this](const std::string& color) {
    return vmesh({"render", "@y.ply", "-o", "@" + color + ".png", "--color", color, "--width", "160"});
  };
  for (const char* color : {"branch", "segment"}) EXPECT_EQ(draw(color).exit_code, 0) << color;
  EXPECT_NE(read("branch.png"), read("segment.png"));
  const Outcome run = draw("twig");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("branch"), std::string::npos) << run.err;
}

TEST_F(Render, GivesTheSameBytesWithAnyNumberOfThreads) {
  write_y("y.swc");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  for (const char* threads : {"1", "3"}) {
    const std::string picture = std::string("@") + threads + ".png";
    const Outcome run =
        vmesh({"render", "@y.ply", "-o", picture, "--color", "segment", "--width", "320", "--threads", threads});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  EXPECT_EQ(read("1.png"), read("3.png"));
}

TEST_F(Render, PicturesArePng) {
  write("t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(vmesh({"render", "@t.off", "-o", "@t.jpg"}).exit_code, 4);
  EXPECT_EQ(vmesh({"render", "@none.off", "-o", "@t.png"}).exit_code, 3);
  EXPECT_FALSE(exists("t.jpg") || exists("t.png"));
}

}  // namespace
}  // namespace vmesh::testing

// A command built without three.js says so before it does anything else.
#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using WithoutPages = CommandTest;

TEST_F(WithoutPages, EveryVerbRefusesThemAtOnce) {
  write_y("y.swc");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "-q"}).exit_code, 0);
  write("scene.json", R"({"schema": "vmesh.scene/1"})");
  const auto before = files();
  const std::vector<std::vector<std::string>> commands = {
      {"generate", "@y.swc", "-o", "@z.ply"},
      {"evaluate", "@y.ply"},
      {"fit", "@y.ply", "@y.ply", "--centerline", "@y.swc", "-o", "@z.ply"},
      {"deform", "@y.swc", "@y.ply", "--script", "@scene.json", "-o", "@moved"},
      {"table2", "--centerline", "@y.swc"},
      {"tradeoff", "@y.swc"}};
  for (std::vector<std::string> command : commands) {
    command.insert(command.end(), {"--html", "@y.html"});
    const Outcome run = vmesh(command);
    EXPECT_EQ(run.exit_code, 4) << command[0];
    for (const char* word : {"--html", "scripts/install-dependencies", "VMESH_WITH_HTML"})
      EXPECT_NE(run.err.find(word), std::string::npos) << command[0] << ": " << run.err;
    EXPECT_EQ(files(), before) << command[0];
  }
}

}  // namespace
}  // namespace vmesh::testing

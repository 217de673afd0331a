#include <chrono>
#include <csignal>
#include <thread>

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

class Interrupt : public CommandTest {
 protected:
  /// Runs `vmesh generate` on a large tree, interrupts it in the middle of the work, and waits for its end.
  Outcome interrupted_by(int signal) {
    if (vmesh({"synth", "--vertices", "20000", "-o", "@large.json"}).exit_code != 0) throw std::runtime_error("synth");
    Process process = start({"generate", "@large.json", "-o", "@large.ply", "--json", "@large_summary.json"});
    // The log line about the centerline comes just before growth, which takes seconds.
    for (int i = 0; i < 3000 && process.err().find("segments") == std::string::npos; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    process.send(signal);
    return process.finish();
  }
};

TEST_F(Interrupt, ControlCEndsWith130AndLeavesNothing) {
  const Outcome run = interrupted_by(SIGINT);
  EXPECT_EQ(run.exit_code, 130) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_NE(run.err.find("interrupted"), std::string::npos) << run.err;
  EXPECT_EQ(files(), std::vector<std::string>{"large.json"});
}

TEST_F(Interrupt, TerminationToo) {
  const Outcome run = interrupted_by(SIGTERM);
  EXPECT_EQ(run.exit_code, 130) << run.err;
  EXPECT_EQ(files(), std::vector<std::string>{"large.json"});
}

}  // namespace
}  // namespace vmesh::testing

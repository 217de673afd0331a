#include "command_line/interrupt.h"

#include <atomic>
#include <csignal>

#include "vmesh/core/error.h"

namespace vmesh::tool {
namespace {

std::atomic<bool> interrupt_flag = false;
static_assert(std::atomic<bool>::is_always_lock_free, "the flag is set in a signal handler");

extern "C" void set_interrupt_flag(int) { interrupt_flag = true; }

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = set_interrupt_flag;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // not SA_RESTART: a wait for a pipe ends
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit becomes a write error
}

bool interrupted() noexcept { return interrupt_flag; }

void stop_if_interrupted() {
  if (interrupted()) throw Cancelled();
}

}  // namespace vmesh::tool

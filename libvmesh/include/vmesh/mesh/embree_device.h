#pragma once

#include <string>

#include "vmesh/core/error.h"

namespace vmesh {

/// One thread and one instruction set, so that the tree of boxes, and with it the choice between faces at the same
/// distance, is the same every time and on every machine.
#if defined(__x86_64__)
constexpr const char* kEmbreeConfig = "threads=1,set_affinity=0,isa=sse4.2";
#else
constexpr const char* kEmbreeConfig = "threads=1,set_affinity=0";
#endif

/// A device keeps all of oneTBB to one thread, or to as many as the device with most of them has: one without a limit,
/// `new_device` being rtcNewDevice, leaves oneTBB its own for as long as the process lives. Trees are built in a
/// task_arena of one thread.
template <class NewDevice>
void leave_threads_to_tbb(NewDevice* new_device) {
  static const auto unlimited = new_device("set_affinity=0");
  static_cast<void>(unlimited);
}

/// `error`: of rtcGetDeviceError().
[[noreturn]] inline void fail_with_embree(int error) {
  throw Error("Embree failed (error " + std::to_string(error) + ")");
}

}  // namespace vmesh

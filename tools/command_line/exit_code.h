#pragma once

namespace vmesh::tool {

/// Exit codes of the command.
enum ExitCode : int {
  kOk = 0,
  kCheckFailed = 1,
  kUsage = 2,
  kBadInput = 3,
  kUnsupported = 4,
  kCannotWrite = 5,
  kNotConverged = 6,
  kDefective = 7,
  kInternal = 70,
  kInterrupted = 130,
};

}  // namespace vmesh::tool

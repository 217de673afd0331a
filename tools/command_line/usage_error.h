#pragma once

#include "vmesh/core/error.h"

namespace vmesh::tool {

/// The command line contradicts itself. Exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

}  // namespace vmesh::tool

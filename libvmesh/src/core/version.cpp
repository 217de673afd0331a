#include "vmesh/core/version.h"

namespace vmesh {

std::string_view version() { return VMESH_VERSION; }

}  // namespace vmesh

#include "text.h"

#include "vmesh/core/error.h"
#include "vmesh/core/version.h"

namespace vmesh::python {

std::string generator_name() { return "vmesh " + std::string(version()) + ", Python"; }

}  // namespace vmesh::python

#include "text.h"

#include "vmesh/core/error.h"
#include "vmesh/core/version.h"

namespace vmesh::python {

std::string generator_name() { return "vmesh " + std::string(version()) + ", Python"; }

LengthUnit unit_of(const std::string& text) {
  if (const auto unit = parse_length_unit(text)) return *unit;
  throw InvalidInput("unit: \"" + text + "\" is not known; there are nm, um, mm, cm, m");
}

Space space_of(const std::string& text) {
  if (const auto space = parse_space(text)) return *space;
  throw InvalidInput("space: \"" + text + "\" is not known; there are LPS and RAS");
}

}  // namespace vmesh::python

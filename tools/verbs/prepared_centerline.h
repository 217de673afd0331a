#pragma once

#include "command_line/console.h"
#include "report/summary.h"

namespace vmesh::tool {

/// The centerline around which the surface grows: without the nodes that it does not need, and with vessels that
/// touched narrowed or moved. Refers to the cleaned centerline, which must outlive it.
struct PreparedCenterline {
  const Centerline* cleaned = nullptr;
  std::optional<SimplifiedCenterline> simplified;
  std::optional<SeparatedCenterline> separated;  ///< of the simplified one

  const Centerline& unseparated() const { return simplified ? simplified->centerline : *cleaned; }
  const Centerline& grown() const { return separated ? separated->centerline : unseparated(); }
};

/// Prepares report.cleaned according to the arguments. Fills in contacts and their separation in the report.
PreparedCenterline prepare_centerline(GenerateReport& report, Console& console);

/// Flat ends of the cleaned centerline with the numbers of the grown one's nodes.
std::vector<EndSection> sections_of_grown(const PreparedCenterline& prepared, std::vector<EndSection> sections);

/// Makes a surface around the grown centerline, and the contacts in the report, refer to the cleaned one.
void refer_to_cleaned(const PreparedCenterline& prepared, GenerateResult& result, GenerateReport& report);

}  // namespace vmesh::tool

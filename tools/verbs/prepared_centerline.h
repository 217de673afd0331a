#pragma once

#include "command_line/console.h"
#include "report/summary.h"

namespace vmesh::tool {

/// The centerline that the surface grows around: without the nodes that it does not need, and where vessels touched
/// narrowed or moved. Refers to the cleaned centerline, which must outlive it.
struct PreparedCenterline {
  const Centerline* cleaned = nullptr;
  std::optional<SimplifiedCenterline> simplified;
  std::optional<SeparatedCenterline> separated;  ///< of the simplified one

  const Centerline& unseparated() const { return simplified ? simplified->centerline : *cleaned; }
  const Centerline& grown() const { return separated ? separated->centerline : unseparated(); }
};

/// Prepares report.cleaned as its arguments say. Fills in what the report says of contacts and their separation.
PreparedCenterline prepare_centerline(GenerateReport& report, Console& console);

/// Makes a surface around the grown centerline, and what the report says of contacts, refer to the cleaned one.
void refer_to_cleaned(const PreparedCenterline& prepared, GenerateResult& result, GenerateReport& report);

}  // namespace vmesh::tool

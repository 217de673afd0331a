#pragma once

#include "command_line/console.h"
#include "report/summary.h"

namespace vmesh::tool {

/// Messages of `vmesh generate` while it works; the summary contains all of it.
/// What preparing the centerline changed, and the contacts, which it puts in the report.
void log_preparation(const PreparedCenterline& prepared, GenerateReport& report, Console& console);
/// The operating points tried for a budget, and the command that makes the one chosen.
void log_choice(const BudgetedSurface& surface, const GenerateArguments& arguments, Console& console);
void log_result(const GenerateReport& report, Console& console);

/// Warns, and keeps the warning for the summary.
void warn(GenerateReport& report, const std::string& text, Console& console);
/// Warns of faces that are not proven to keep to the limit.
void warn_of_error(GenerateReport& report, Console& console);

/// Says why nothing is written.
void log_refusal(const GenerateReport& report, Console& console);
/// The same for any defects, one line each, of which the first are shown, and what to do.
void log_refusal(const std::vector<std::string>& defects, const std::string& what_to_do, Console& console);

}  // namespace vmesh::tool

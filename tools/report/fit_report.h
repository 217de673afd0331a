#pragma once

#include "command_line/console.h"
#include "report/summary.h"

namespace vmesh::tool {

/// The results of a fit, for a summary.
Json to_json(const FitReport& report);

/// The same in a few lines, with a warning for every unmatched region.
void log_fit(const FitReport& report, std::vector<std::string>& warnings, Console& console);

/// Whether 95 % keep to the error that was asked for, and all to the largest one; warns if not.
bool keeps_error(const FitReport& report, const FitOptions& options, std::vector<std::string>& warnings,
                 Console& console);

/// "--fit-error 0.3mm ...": how a surface was fitted.
std::string describe(const FittingArguments& arguments);

}  // namespace vmesh::tool

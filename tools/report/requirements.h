#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/evaluation_report.h"

namespace vmesh::tool {

/// One requirement on a surface: "closed", "max-skewness=0.9".
struct Requirement {
  std::string name;
  std::optional<double> value;
};

/// Parses "closed,max-skewness=0.9". Throws UsageError for an unknown name (listing the known ones), and for a missing,
/// superfluous or invalid number.
std::vector<Requirement> parse_requirements(const std::string& list);

/// Throws UsageError if a requirement needs a comparison that was not requested.
void check_requirements_can_be_checked(const std::vector<Requirement>& requirements, bool with_reference,
                                       bool with_centerline);

/// A guaranteed distance meets a requirement when its upper bound does.
CheckedRequirement check_requirement(const Requirement& requirement, const EvaluationReport& report);

/// Names and meanings, for help.
std::string describe_requirements();

}  // namespace vmesh::tool

#pragma once

#include <optional>

#include "vmesh/comparison/method_comparison.h"
#include "vmesh/skeleton/extract_centerline.h"

#include "report/report_table.h"
#include "report/summary.h"

namespace vmesh::tool {

/// An input file; no path: none.
struct SourceFile {
  std::string path, sha256;
};

/// The vessels of Table 2.
struct Table2Source {
  std::string vessels;          ///< in words
  std::string contour_of;       ///< "binary" or "grey"; empty if the reference is a given surface
  Vec3 spacing = Vec3::Zero();  ///< of the voxels contoured, mm
  std::size_t components = 0;   ///< of the contour, before any were removed
  SourceFile reference, centerline;
  std::optional<ExtractionReport> extraction;  ///< when the centerline was extracted
};

/// Everything `vmesh table2` reports. Schema "vmesh.table2/1".
struct Table2Report {
  Table2Source source;
  Centerline centerline;
  double tolerance_mm = 0;
  MethodComparison comparison;
  std::vector<std::string> warnings;
};

Json to_json(const Table2Report& report);
std::vector<ReportTable> to_tables(const Table2Report& report);

/// The method, and for surfaces grown by vmesh its resolution: "low resolution, 6 around".
std::string name_of(const MethodRow& row);

/// The figures that are worse than the paper's, in one line.
std::string worse_than_paper(const MethodComparison& comparison);

}  // namespace vmesh::tool

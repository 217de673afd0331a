// The pages of the verbs.
#pragma once

#include <optional>

#include "vmesh/tuning/tradeoff.h"

#include "page/page.h"
#include "report/evaluation_report.h"
#include "report/summary.h"
#include "report/table2_report.h"

namespace vmesh::tool {

/// Page of a surface grown around `grown`, with `attributes` as written; `reference`: what it was fitted to, or null.
Page page_of(const GenerateReport& report, const Centerline& grown, MeshAttributes attributes,
             const TriMesh* reference);

/// Page of a measured surface. `attributes` include distances.
Page page_of(const CommonArguments& common, const EvaluationReport& report, const TriMesh& mesh,
             MeshAttributes attributes, const TriMesh* reference, const Centerline* centerline);

/// Page of a fitted surface; `summary` is what --json writes.
Page page_of(const CommonArguments& common, const FitReport& report, const Json& summary, const TriMesh& mesh,
             MeshAttributes attributes, const TriMesh& reference, const Centerline& centerline);

Page page_of(const CommonArguments& common, const Table2Report& report);

/// Page of a comparison of settings around the centerline of the file `input`.
Page page_of(const CommonArguments& common, const std::filesystem::path& input, const Centerline& centerline,
             const std::vector<TradeoffPoint>& points, std::vector<ReportTable> tables);

/// Page of the motion of the scene `script`, from `rest` to `moved`, which has the `attributes`; `summary` is what
/// --json writes.
Page page_of(const CommonArguments& common, const std::filesystem::path& script, const Json& summary,
             const TriMesh& rest, const TriMesh& moved, MeshAttributes attributes, const Centerline& centerline,
             PageFrames frames);

}  // namespace vmesh::tool

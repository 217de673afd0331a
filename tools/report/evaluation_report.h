#pragma once

#include <optional>

#include "vmesh/evaluation/vessel_distance.h"
#include "vmesh/quality/hausdorff.h"
#include "vmesh/quality/quality_report.h"
#include "vmesh/quality/sampled_distance.h"

#include "report/report_table.h"
#include "report/summary.h"

namespace vmesh::tool {

/// A surface compared with another one.
struct ReferenceComparison {
  std::string file;
  std::size_t faces = 0;
  double tolerance_mm = 0;
  Hausdorff hausdorff;  ///< forward: from the surface to the reference
  SampledDistance forward, backward;
};

/// A surface compared with the round cones of a centerline.
struct VolumeComparison {
  std::string file;
  VesselDistance distance;
};

/// What a measure of all faces is like.
struct MeasureSummary {
  std::string name;
  Distribution distribution;
  Histogram histogram;
};

/// In the order of for_each_face_measure().
std::vector<MeasureSummary> summarize_measures(const FaceMeasures& measures);

/// A requirement of the caller and what was found.
struct CheckedRequirement {
  std::string text;
  std::string found;
  bool met = false;
};

/// Everything `vmesh evaluate` reports. Schema "vmesh.evaluation/1".
struct EvaluationReport {
  std::string file, sha256;
  std::size_t vertices = 0, faces = 0;
  double area_mm2 = 0;
  std::optional<double> volume_mm3;  ///< of a closed, oriented surface
  FaceMeasures measures;
  std::vector<MeasureSummary> measure_summaries;
  DefectReport defects;
  std::optional<ReferenceComparison> reference;
  std::optional<VolumeComparison> volume;
  std::vector<CheckedRequirement> requirements;
  std::vector<std::string> warnings;
};

/// One direction between two surfaces.
Json side_json(const OneSidedHausdorff& side, const SampledDistance& sampled);
Json to_json(const EvaluationReport& report);
std::vector<ReportTable> to_tables(const EvaluationReport& report);

}  // namespace vmesh::tool

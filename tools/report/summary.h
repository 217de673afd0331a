#pragma once

#include <optional>

#include "vmesh/centerline/cleaning.h"
#include "vmesh/fit/fit_surface.h"
#include "vmesh/surface/deviation.h"
#include "vmesh/surface/flat_ends.h"
#include "vmesh/surface/surface_attributes.h"
#include "vmesh/volume/contacts.h"

#include "report/json.h"
#include "report/measure.h"
#include "verbs/generate_arguments.h"

namespace vmesh::tool {

/// Everything `vmesh generate` reports. Schema "vmesh.summary/1".
struct GenerateReport {
  const GenerateArguments* arguments = nullptr;
  std::string input_sha256;
  std::vector<std::string> radius_arrays;  ///< of the input, see RawCenterline
  const CleanedCenterline* cleaned = nullptr;
  std::vector<Contact> contacts;               ///< of the cleaned centerline
  std::optional<SeparationReport> separation;  ///< when vessels that touch were narrowed or moved
  const GenerateResult* result = nullptr;
  FlatEnds ends;                      ///< the ends that are not round
  std::vector<EndName> end_names;     ///< those that a user gave
  Index wall_patches = 1;             ///< into which the wall is divided
  std::size_t wall_vertices = 0;      ///< before ends were capped or extended
  std::vector<OperatingPoint> tried;  ///< for a budget
  SurfaceMeasurement measurement;
  std::size_t grown_nodes = 0;              ///< of the centerline that was grown, including those added by separation
  std::optional<std::size_t> nodes_inside;  ///< of them
  Deviation deviation;           ///< from the vessels as grown: after separation, the narrowed and moved ones
  Deviation rounding;            ///< of the boundary at branches, against the plain union
  std::optional<FitReport> fit;  ///< with a reference to fit to
  std::optional<ExtractionReport> extraction;  ///< of the centerline, from a segmentation
  std::vector<StageTime> stages;               ///< of the whole run
  std::vector<std::string> warnings, problems;
};

Json to_json(const GenerateReport& report);

/// JSON that several verbs use.
Json to_json(const Centerline& centerline);
Json to_json(const CleaningReport& report);
Json to_json(const GrowthSummary& growth);
Json to_json(const ExtractionReport& report);
Json stages_json(const std::vector<StageTime>& stages);
Json openings_json(const GenerateResult& result);
/// `wall_patches`: into which the wall is divided.
Json caps_json(const FlatEnds& ends, const std::vector<EndName>& names, Index wall_patches);
/// Without their rings.
Json to_json(const std::vector<EndSection>& sections);
Json to_json(const SurfaceMeasurement& measurement);

/// "--beta 0.3 --blend 0.5 ...": how a surface was made.
std::string describe(const GenerateArguments& arguments);

}  // namespace vmesh::tool

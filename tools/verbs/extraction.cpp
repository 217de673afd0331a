#include "verbs/extraction.h"

#include <sstream>

#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/usage_error.h"
#include "report/extraction_report.h"
#include "verbs/fitting.h"

namespace vmesh::tool {

void check_extraction(const InputArguments& input, const ReferenceOptions& image, const ExtractOptions& options) {
  check_options_of_image(input.path, image);
  if (is_image(input.path) && options.balanced_wall)
    throw UsageError(input.path.string() + ": --balanced-wall is for surfaces; this is taken for an image");
}

ExtractedCenterline extract(const InputArguments& input, const ReferenceOptions& image, const ExtractOptions& options,
                            std::vector<StageTime>& stages, Console& console) {
  StageClock clock;
  ExtractedCenterline extracted = naming(input.path, [&] {
    if (is_image(input.path)) {
      VesselMask mask = load_vessel_mask(input, image, console);
      clock.lap("read", stages);
      stop_if_interrupted();
      return extract_centerline(std::move(mask), options, console.progress());
    }
    LoadedSurface surface = load_surface(input);
    console.warn(surface.warnings);
    clock.lap("read", stages);
    stop_if_interrupted();
    return extract_centerline(surface.mesh, options, console.progress());
  });
  stages.insert(stages.end(), extracted.report.stages.begin(), extracted.report.stages.end());
  log_extraction(extracted, console);
  return extracted;
}

bool meets(const RequiredCoverage& required, const ExtractionReport& report, Console& console) {
  const auto check = [&](const char* name, double value, double least) {
    if (value >= least) return true;
    std::ostringstream text;
    text << name << " is " << value << ", required are " << least;
    console.warn(text.str());
    return false;
  };
  const bool wall = check("coverage", report.coverage, required.wall);
  return check("length-coverage", report.length_coverage, required.length) && wall;
}

}  // namespace vmesh::tool

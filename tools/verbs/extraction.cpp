#include "verbs/extraction.h"

#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/usage_error.h"
#include "report/extraction_report.h"
#include "verbs/fitting.h"

namespace vmesh::tool {

void check_extraction(const InputArguments& input, const ReferenceOptions& image) {
  if (!is_image(input.path) && has_options(image))
    throw UsageError(input.path.string() +
                     ": --label, --threshold, --spacing and --smooth are for images; this is taken for a surface");
}

ExtractedCenterline extract(const InputArguments& input, const ReferenceOptions& image, const ExtractOptions& options,
                            Console& console) {
  ExtractedCenterline extracted = naming(input.path, [&] {
    if (is_image(input.path)) {
      VesselMask mask = load_vessel_mask(input, image, console);
      stop_if_interrupted();
      return extract_centerline(std::move(mask), options, console.progress());
    }
    LoadedSurface surface = load_surface(input);
    console.warn(surface.warnings);
    stop_if_interrupted();
    return extract_centerline(surface.mesh, options, console.progress());
  });
  log_extraction(extracted, console);
  return extracted;
}

}  // namespace vmesh::tool

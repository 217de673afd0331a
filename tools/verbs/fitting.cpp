#include "verbs/fitting.h"

#include <cmath>

#include "command_line/inputs.h"
#include "command_line/usage_error.h"

namespace vmesh::tool {

bool has_options(const ReferenceOptions& image) {
  return !image.labels.empty() || !image.segments.empty() || image.threshold || image.spacing > 0 || image.smooth > 0;
}

void check_options_of_image(const std::filesystem::path& input, const ReferenceOptions& image) {
  if (!is_image(input) && has_options(image))
    throw UsageError(input.string() +
                     ": --label, --threshold, --spacing and --smooth are for images; this is taken for a surface");
}

void set_budget(const Budget& budget, FitOptions& options) {
  if (budget.kind == Budget::Kind::vertices) {
    options.max_vertices = budget.vertices;
    return;
  }
  if (budget.kind != Budget::Kind::error || !std::isfinite(budget.error.mm) || std::isfinite(budget.error.relative))
    throw UsageError("a fit takes budgets such as vertices=5000 and error=0.2mm, not " + to_string(budget));
  options.error = budget.error.mm;
}

TriMesh load_fit_reference(const FittingArguments& arguments, Console& console) {
  const std::filesystem::path& path = arguments.reference.path;
  const ReferenceOptions& image = arguments.image;
  if (is_image(path)) {
    return naming(path, [&] {
      ReferenceOptions options = image;
      options.all_components = true;  // the fit decides what belongs to a vessel
      return reference_surface(load_image(arguments.reference, options, console), options).mesh;
    });
  }
  check_options_of_image(path, image);
  LoadedSurface surface = load_surface(arguments.reference);
  console.warn(surface.warnings);
  return std::move(surface.mesh);
}

}  // namespace vmesh::tool

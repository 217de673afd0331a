#include "vmesh/render/render.h"

#include <array>
#include <utility>

#include "vmesh/mesh/triangle_quality.h"

#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "verbs/verbs.h"

namespace vmesh::tool {
namespace {

struct FoundAttribute {
  const MeshAttribute* attribute;
  AttributeDomain domain;
};

bool is_label(const std::string& name) { return name == "branch" || name == "group"; }

/// Vertex attributes are preferred, as they vary smoothly; for labels face attributes are, as their borders are crisp.
FoundAttribute find_attribute(const LoadedSurface& surface, const std::string& name) {
  std::string known;
  std::array lists = {std::pair{&surface.attributes.vertex, AttributeDomain::vertex},
                      std::pair{&surface.attributes.face, AttributeDomain::face}};
  if (is_label(name)) std::swap(lists[0], lists[1]);
  for (const auto& [list, domain] : lists)
    for (const MeshAttribute& attribute : *list) {
      if (attribute.name == name) return {&attribute, domain};
      known += (known.empty() ? "" : ", ") + attribute.name;
    }
  throw InvalidInput("there is no attribute " + name + " to colour by; the file has " +
                     (known.empty() ? "none" : known));
}

MeshAttribute skewness_of(const TriMesh& mesh) { return {"skewness", equiangle_skewness(mesh)}; }

Image draw(const LoadedSurface& surface, const RenderArguments& arguments) {
  if (arguments.color.empty()) return render(surface.mesh, arguments.options);
  if (arguments.color == "skewness")
    return render(surface.mesh, skewness_of(surface.mesh), AttributeDomain::face, arguments.options);
  const auto [attribute, domain] = find_attribute(surface, arguments.color);
  RenderOptions options = arguments.options;
  options.categories = is_label(arguments.color);
  return render(surface.mesh, *attribute, domain, options);
}

}  // namespace

int run(const RenderArguments& arguments, Console& console) {
  check_outputs({{arguments.output, PlannedOutput::Kind::picture}}, files_of(arguments.input.path));
  const LoadedSurface surface = load_surface(arguments.input);
  console.warn(surface.warnings);
  stop_if_interrupted();
  const Image image = draw(surface, arguments);
  stop_if_interrupted();
  write_png(arguments.output, image);
  console.log("wrote " + arguments.output.string());
  return kOk;
}

}  // namespace vmesh::tool

#include <array>

#include "vmesh/core/error.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/render/render.h"

namespace vmesh {
namespace {

struct FoundAttribute {
  const MeshAttribute* attribute;
  AttributeDomain domain;
};

bool is_label(const std::string& name) { return name == "branch" || name == "group"; }

/// Vertex attributes are preferred, as they vary smoothly; for labels face attributes are, as their borders are crisp.
FoundAttribute attribute_to_color_by(const MeshAttributes& attributes, const std::string& name) {
  std::string known;
  std::array lists = {std::pair{&attributes.vertex, AttributeDomain::vertex},
                      std::pair{&attributes.face, AttributeDomain::face}};
  if (is_label(name)) std::swap(lists[0], lists[1]);
  for (const auto& [list, domain] : lists) {
    for (const MeshAttribute& attribute : *list) {
      if (attribute.name == name) return {&attribute, domain};
      known += (known.empty() ? "" : ", ") + attribute.name;
    }
  }
  throw InvalidInput("there is no attribute " + name + " to colour by; the surface has " +
                     (known.empty() ? "none" : known));
}

}  // namespace

Image render(const TriMesh& mesh, const MeshAttributes& attributes, const std::string& color,
             const RenderOptions& options) {
  if (color == "skewness")
    return render(mesh, MeshAttribute{"skewness", equiangle_skewness(mesh)}, AttributeDomain::face, options);
  const auto [attribute, domain] = attribute_to_color_by(attributes, color);
  RenderOptions of_attribute = options;
  of_attribute.categories = is_label(color);
  return render(mesh, *attribute, domain, of_attribute);
}

}  // namespace vmesh

#include "vmesh/core/error.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/render/render.h"

namespace vmesh {
namespace {

struct FoundAttribute {
  const MeshAttribute* attribute;
  AttributeDomain domain;
};

/// Whether the values are labels without an order, not amounts.
bool is_label(const MeshAttribute& attribute) {
  const std::string& name = attribute.name;
  if (name == "red" || name == "green" || name == "blue" || name == "alpha") return false;
  return attribute.integer || name == "branch" || name == "group";
}

/// Vertex attributes are preferred, as they vary smoothly; for labels face attributes are, as their borders are crisp.
FoundAttribute attribute_to_color_by(const MeshAttributes& attributes, const std::string& name) {
  const MeshAttribute *of_vertices = find_attribute(attributes.vertex, name),
                      *of_faces = find_attribute(attributes.face, name);
  if (of_faces && (!of_vertices || is_label(*of_faces))) return {of_faces, AttributeDomain::face};
  if (of_vertices) return {of_vertices, AttributeDomain::vertex};
  std::string known;
  for (const auto* list : {&attributes.vertex, &attributes.face}) {
    for (const MeshAttribute& attribute : *list) known += (known.empty() ? "" : ", ") + attribute.name;
  }
  throw InvalidInput("there is no attribute " + name + " to colour by; the surface has " +
                     (known.empty() ? "none" : known));
}

}  // namespace

Image render(const TriMesh& mesh, const MeshAttributes& attributes, const std::string& color,
             const RenderOptions& options, const Progress& progress) {
  if (color == "skewness")
    return render(mesh, MeshAttribute{"skewness", equiangle_skewness(mesh)}, AttributeDomain::face, options, progress);
  const auto [attribute, domain] = attribute_to_color_by(attributes, color);
  RenderOptions of_attribute = options;
  of_attribute.categories = is_label(*attribute) && !options.range;
  return render(mesh, *attribute, domain, of_attribute, progress);
}

}  // namespace vmesh

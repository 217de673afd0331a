#include <pybind11/stl/filesystem.h>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"
#include "vmesh/core/file_format.h"
#include "vmesh/evaluation/vessel_distance.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/quality/sampled_distance.h"
#include "vmesh/volume/vessel_field.h"

#if VMESH_PYTHON_WITH_PAGES
#include "report/growth_content.h"
#include "report/page_content.h"
#endif

#include "attributes.h"
#include "module.h"
#include "running.h"

namespace vmesh::python {
namespace {

namespace fs = std::filesystem;

#if VMESH_PYTHON_WITH_PAGES

void add_facts(tool::Page& page, const SurfaceObject& surface) {
  const SkewnessSummary skewness = summarize_skewness(surface.mesh());
  page.facts = {{"Vertices", std::to_string(surface.mesh().vertices.size())},
                {"Faces", std::to_string(surface.mesh().faces.size())},
                {"Skewness, mean / max", tool::mean_and_max(skewness.mean, skewness.max)}};
  if (surface.centerline)
    page.facts.push_back({"Centerline", std::to_string(surface.centerline->centerline.nodes().size()) + " nodes"});
}

/// The attributes to colour by: those of the surface, distances, skewness.
MeshAttributes shown_attributes(const SurfaceObject& surface, const SurfaceObject* reference) {
  const TriMesh& mesh = surface.mesh();
  MeshAttributes attributes = attributes_of(surface);
  if (surface.centerline)
    attributes.vertex.push_back(
        {"volume_distance", vertex_vessel_distances(mesh, VesselField(surface.centerline->centerline))});
  if (reference != nullptr)
    attributes.vertex.push_back({"distance", vertex_distances(mesh, ClosestPointIndex(reference->mesh()))});
  if (find_attribute(attributes.face, "EquiangleSkewness") == nullptr)
    attributes.face.push_back({"EquiangleSkewness", equiangle_skewness(mesh)});
  return attributes;
}

std::string page_about(const SurfaceObject& surface, const SurfaceObject* reference, const std::string& title) {
  tool::Page page;
  page.title = title;
  page.verb = "page";
  page.command_line = "vmesh.page() in Python";
  page.surfaces.push_back({"surface", surface.mesh(), shown_attributes(surface, reference)});
  if (reference != nullptr) page.surfaces.push_back({"reference", reference->mesh(), {}, true});
  if (surface.centerline) page.centerline = surface.centerline->centerline;
  page.warnings = surface.warnings;
  add_facts(page, surface);
  tool::add_defects(page, surface.result.defects);
  const tool::PageSurface shown = page.surfaces.front();
  tool::add_largest(page, shown, "distance", "Vertex far from the reference", " mm", tool::kMarksOfEach);
  tool::add_largest(page, shown, "volume_distance", "Vertex far from the vessels", " mm", tool::kMarksOfEach);
  tool::add_largest(page, shown, "EquiangleSkewness", "Skew triangle", "", tool::kMarksOfEach);
  tool::add_histograms(page, shown);
  return tool::to_html(page);
}

#else

std::string page_about(const SurfaceObject&, const SurfaceObject*, const std::string&) {
  throw Unsupported(
      "this vmesh was built without pages; build it after scripts/install-dependencies, with -DVMESH_WITH_HTML=ON and "
      "the command");
}

#endif

void write_page(const SurfaceObject& surface, const fs::path& path, const SurfaceObject* reference,
                const std::optional<std::string>& title) {
  const std::string extension = extension_of(path);
  if (extension != ".html" && extension != ".htm")
    throw Unsupported(path.string() + ": pages are written as .html or .htm");
  check_can_be_written(path);
  const std::string html = page_about(surface, reference, title.value_or(path.filename().string()));
  AtomicFile file(path);
  file.write(html);
  file.commit();
}

}  // namespace

void bind_pages(py::module_& module) {
  module.def(
      "page",
      [](const SurfacePtr& surface, const fs::path& path, const SurfacePtr& reference,
         const std::optional<std::string>& title) {
        run(py::none(), [&](const Progress&) { write_page(*surface, path, reference.get(), title); });
      },
      py::arg("surface").none(false), py::arg("path"), py::kw_only(), py::arg("reference"), py::arg("title"),
      "vmesh.page() for a Surface.");
  module.def(
      "page_text",
      [](const SurfacePtr& surface, const std::string& title) {
        std::string html;
        run(py::none(), [&](const Progress&) { html = page_about(*surface, nullptr, title); });
        return html;
      },
      py::arg("surface").none(false), py::arg("title"),
      "The page of a Surface as text. Raises Unsupported in a build without pages.");
}

}  // namespace vmesh::python

#include <variant>

#include <pybind11/stl/filesystem.h>

#include "vmesh/render/render.h"

#include "arrays.h"
#include "attributes.h"
#include "module.h"
#include "running.h"

namespace vmesh::python {
namespace {

namespace fs = std::filesystem;

/// What to colour by: nothing, an attribute by its name, or a number for every vertex or face.
using ColorBy = std::variant<std::monostate, std::string, py::array>;

ViewDirection direction_of(const std::variant<std::string, std::pair<double, double>>& view) {
  if (const auto* name = std::get_if<std::string>(&view)) return view_direction(*name);
  const auto [azimuth, elevation] = std::get<std::pair<double, double>>(view);
  return {azimuth, elevation};
}

/// (height, width, 3) uint8.
py::array pixels_of(const Image& image) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * image.pixels.size());
  for (const Color& color : image.pixels) bytes.insert(bytes.end(), color.begin(), color.end());
  return array_of(std::move(bytes)).attr("reshape")(image.height, image.width, 3);
}

Image drawn(const SurfacePtr& surface, const ColorBy& color, const RenderOptions& options) {
  const TriMesh& mesh = surface->mesh();
  const auto draw = [&](const auto& work) { return result_of(py::none(), work); };
  if (const auto* name = std::get_if<std::string>(&color))
    return draw([&](const Progress& p) { return render(mesh, attributes_of(*surface), *name, options, p); });
  const auto* values = std::get_if<py::array>(&color);
  if (values == nullptr) return draw([&](const Progress& p) { return render(mesh, options, p); });
  const bool of_vertices = values->size() == static_cast<py::ssize_t>(mesh.vertices.size());
  const std::size_t count = of_vertices ? mesh.vertices.size() : mesh.faces.size();
  const MeshAttribute attribute{"color", to_numbers(*values, "color", count)};
  const AttributeDomain domain = of_vertices ? AttributeDomain::vertex : AttributeDomain::face;
  return draw([&](const Progress& p) { return render(mesh, attribute, domain, options, p); });
}

}  // namespace

void bind_pictures(py::module_& module) {
  module.def(
      "render",
      [](const SurfacePtr& surface, const std::optional<fs::path>& path, const ColorBy& color, int width, int height,
         const std::variant<std::string, std::pair<double, double>>& view, const py::object& look_at,
         double view_height, double zoom, double field_of_view, bool edges, double edge_width, bool smooth,
         bool back_faces, double occlusion, bool legend, const std::optional<std::pair<double, double>>& range) {
        RenderOptions options;
        options.width = width;
        options.height = height;
        options.view = direction_of(view);
        if (!look_at.is_none()) options.look_at = to_point(look_at, "look_at");
        options.view_height_mm = view_height;
        options.zoom = zoom;
        options.field_of_view_deg = field_of_view;
        options.edges = edges;
        options.edge_width_px = edge_width;
        options.smooth = smooth;
        options.highlight_back_faces = back_faces;
        options.occlusion = occlusion;
        options.legend = legend;
        options.range = range;
        const Image image = drawn(surface, color, options);
        if (path) write_png(*path, image);
        return pixels_of(image);
      },
      py::arg("surface").none(false), py::kw_only(), py::arg("path"), py::arg("color"), py::arg("width"),
      py::arg("height"), py::arg("view"), py::arg("look_at"), py::arg("view_height"), py::arg("zoom"),
      py::arg("field_of_view"), py::arg("edges"), py::arg("edge_width"), py::arg("smooth"), py::arg("back_faces"),
      py::arg("occlusion"), py::arg("legend"), py::arg("range"), "vmesh.render() for a Surface.");
}

}  // namespace vmesh::python

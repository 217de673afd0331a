#include <pybind11/stl/filesystem.h>

#include "vmesh/deform/volume_places.h"
#include "vmesh/io/volume_io.h"
#include "vmesh/solid/branch_regions.h"
#include "vmesh/solid/make_volume.h"

#include "arrays.h"
#include "attributes.h"
#include "module.h"
#include "objects.h"
#include "running.h"
#include "text.h"

namespace vmesh::python {
namespace {

namespace fs = std::filesystem;

/// vmesh.VolumeMesh. Immutable, as arrays are views of it.
struct VolumeObject {
  VolumeResult result;  ///< for a mesh from a file: the mesh and its defects
  std::vector<std::string> warnings;

  const VolumeMesh& mesh() const { return result.mesh; }
};
using VolumePtr = std::shared_ptr<VolumeObject>;

constexpr double kFarthestCell = 4;  // local radii: a cell farther off belongs to another centerline

VolumePtr make_volume_in(const SurfaceObject& surface, const VolumeOptions& options, const Progress& progress) {
  auto volume = std::make_shared<VolumeObject>();
  volume->result = make_volume(vessel_wall(surface.mesh(), attributes_of(surface)), options, progress);
  return volume;
}

VolumePtr read_volume_file(const fs::path& path) {
  const py::gil_scoped_release release;
  LoadedVolume loaded = read_volume(path);
  if (loaded.unit != LengthUnit::mm || loaded.space != Space::lps)
    throw InvalidInput(path.string() + ": volumes are read in millimetres and LPS, as they are written by default");
  auto volume = std::make_shared<VolumeObject>();
  volume->result.mesh = std::move(loaded.mesh);
  volume->result.defects = find_volume_defects(volume->mesh());
  volume->warnings = std::move(loaded.warnings);
  return volume;
}

void save_volume(const VolumeObject& self, const fs::path& path, const std::string& unit, const std::string& space,
                 bool tetrahedra) {
  VolumeMetadata metadata;
  metadata.generator = generator_name();
  metadata.unit = require_length_unit(unit);
  metadata.space = require_space(space);
  const py::gil_scoped_release release;
  write_volume(path, self.mesh(), metadata, {}, {.split_cells = tetrahedra});
}

VolumePtr with_branches(const VolumeObject& self, const CenterlineObject& centerline) {
  const py::gil_scoped_release release;
  auto volume = std::make_shared<VolumeObject>(self);
  volume_places(centerline.centerline, self.mesh(), {}, {}, kFarthestCell);  // throws
  divide_regions(volume->result.mesh, branches_of_cells(self.mesh(), centerline.centerline));
  return volume;
}

const VolumeMesh& mesh_of(const py::object& self) { return self.cast<const VolumeObject&>().mesh(); }

/// (m, corners) uint32.
template <std::size_t corners>
py::array cells_view(const std::vector<std::array<Index, corners>>& cells, const py::object& owner) {
  return view(cells.empty() ? nullptr : cells.front().data(),
              {static_cast<py::ssize_t>(cells.size()), static_cast<py::ssize_t>(corners)},
              {static_cast<py::ssize_t>(sizeof(cells.front())), static_cast<py::ssize_t>(sizeof(Index))}, owner);
}

/// (k, 4) int64, -1 for the fourth corner of triangles.
py::array boundary_of(const VolumeObject& self) {
  std::vector<std::int64_t> corners;
  corners.reserve(4 * self.mesh().boundary.size());
  for (const BoundaryFace& face : self.mesh().boundary) {
    for (const Index v : face.corners) corners.push_back(v == kNone ? -1 : static_cast<std::int64_t>(v));
  }
  return array_of(std::move(corners)).attr("reshape")(-1, 4);
}

py::array patches_of(const py::object& self) {
  const std::vector<BoundaryFace>& boundary = mesh_of(self).boundary;
  return member_view(boundary, boundary.empty() ? nullptr : &boundary.front().patch, self);
}

py::dict by_name(const std::vector<std::string>& names, const std::vector<double>& values) {
  py::dict result;
  for (std::size_t i = 0; i < names.size(); ++i) result[py::str(names[i])] = values[i];
  return result;
}

std::string describe_volume(const VolumeObject& self) {
  const VolumeMesh& mesh = self.mesh();
  std::string text = "<vmesh.VolumeMesh: " + counted(mesh.points.size(), "point") + ", " +
                     counted(mesh.tetrahedra.size(), "tetrahedron", "tetrahedra") + ", " +
                     counted(mesh.wedges.size(), "wedge") + ", " + counted(mesh.pyramids.size(), "pyramid");
  if (!self.result.defects.empty()) text += ", " + counted(self.result.defects.size(), "defect");
  return text + ">";
}

void bind_volume_parts(py::module_& module) {
  py::class_<VolumeDefect>(module, "VolumeDefect", "Something that a sound volume mesh must not have.")
      .def_property_readonly(
          "kind", [](const VolumeDefect& d) { return std::string(to_string(d.kind)); },
          "not_filled, inverted_cell, not_conforming, wrong_label, crossing_faces or other_boundary.")
      .def_property_readonly(
          "position", [](const VolumeDefect& d) { return array_of(d.position); }, "(3,) mm, of the first.")
      .def_readonly("count", &VolumeDefect::count, "How many.")
      .def_readonly("message", &VolumeDefect::message, "What, how many, where.")
      .def("__repr__", [](const VolumeDefect& d) {
        return "<vmesh.VolumeDefect " + std::string(to_string(d.kind)) + ": " + d.message + ">";
      });
  py::class_<ThinPlace>(module, "ThinPlace", "Where layers end, or are thinner than asked for.")
      .def_property_readonly(
          "position", [](const ThinPlace& p) { return array_of(p.position); }, "(3,) mm, where they are thinnest.")
      .def_readonly("asked", &ThinPlace::asked_mm, "Thickness that was asked for there, mm.")
      .def_readonly("reached", &ThinPlace::reached_mm, "Thickness there, mm; 0: they end.")
      .def_readonly("vertices", &ThinPlace::vertices, "Of the wall, in this place.")
      .def_property_readonly(
          "limit", [](const ThinPlace& p) { return std::string(to_string(p.limit)); },
          "Why: gradation (layers nearby are thinner), shape (cells would turn over) or room (another place's "
          "layers).");
  py::class_<LayerSummary>(module, "LayerSummary", "How thick layers of wedges became.")
      .def_readonly("full_share", &LayerSummary::full_share,
                    "Of the wall's area, with nine tenths of the thickness that was asked for.")
      .def_readonly("least_share", &LayerSummary::least_share, "Of that thickness, anywhere.")
      .def_readonly("thin", &LayerSummary::thin, "Places where they are thinner: ThinPlace, thinnest first.");
  py::class_<VolumeMeasures>(module, "VolumeMeasures", "Figures of a volume mesh.")
      .def_readonly("min_dihedral", &VolumeMeasures::min_dihedral_deg, "Of tetrahedra, degrees.")
      .def_readonly("max_dihedral", &VolumeMeasures::max_dihedral_deg, "Of tetrahedra, degrees.")
      .def_readonly("least_radius_ratio", &VolumeMeasures::least_radius_ratio,
                    "Of tetrahedra: 3 inradius / circumradius, 1 if regular.")
      .def_readonly("mean_radius_ratio", &VolumeMeasures::mean_radius_ratio, "The same, in the mean.")
      .def_readonly("least_scaled_jacobian", &VolumeMeasures::least_scaled_jacobian,
                    "Of wedges: the smallest Bezier coefficient of the determinant by the largest.")
      .def_property_readonly(
          "worst_tetrahedron", [](const VolumeMeasures& m) { return array_of(m.worst_tetrahedron); },
          "(3,) mm, where min_dihedral is.");
}

void bind_volume_mesh(py::module_& module) {
  py::class_<VolumeObject, VolumePtr>(
      module, "VolumeMesh", R"(Cells that meet face to face: tetrahedra, wedges, pyramids, numbered in this order.

A volume mesh never changes: its arrays are views of its memory, not writable, and keep it alive.
The vertices of the surface's wall come first among its points, in their order.)")
      .def_property_readonly(
          "points", [](const py::object& self) { return points_view(mesh_of(self).points, self); },
          "Positions, (n, 3) float64, mm, LPS.")
      .def_property_readonly(
          "tetrahedra", [](const py::object& self) { return cells_view(mesh_of(self).tetrahedra, self); },
          "Corners, (m, 4) uint32; the fourth is on the side that the normal of the others points to.")
      .def_property_readonly(
          "wedges", [](const py::object& self) { return cells_view(mesh_of(self).wedges, self); },
          "Corners, (k, 6) uint32: a triangle, and over it another, on the side that its normal points to.")
      .def_property_readonly(
          "pyramids", [](const py::object& self) { return cells_view(mesh_of(self).pyramids, self); },
          "Corners, (p, 5) uint32: a quadrilateral, and the tip on the side that its normal points to.")
      .def_property_readonly(
          "cell_region", [](const py::object& self) { return vector_view(mesh_of(self).cell_region, self); },
          "Index into region_names of every cell, (cells,) uint32.")
      .def_property_readonly(
          "region_names", [](const VolumeObject& self) { return self.mesh().region_names; }, "lumen, wall ...")
      .def_property_readonly("boundary_faces", &boundary_of,
                             "Corners of the outside, (b, 4) int64, counter-clockwise seen from outside; -1 in the "
                             "last column for triangles.\nMade anew each time.")
      .def_property_readonly("boundary_patch", &patches_of, "Index into patch_names of these faces, (b,) uint32.")
      .def_property_readonly(
          "patch_names", [](const VolumeObject& self) { return self.mesh().patch_names; }, "wall, cap_1 ...")
      .def_property_readonly(
          "measures", [](const VolumeObject& self) { return measure_volume(self.mesh()); },
          "Quality: VolumeMeasures. Made anew each time.")
      .def_property_readonly(
          "region_volume",
          [](const VolumeObject& self) {
            return by_name(self.mesh().region_names, measure_volume(self.mesh()).region_volume_mm3);
          },
          "mm^3, by the names of regions.")
      .def_property_readonly(
          "patch_area",
          [](const VolumeObject& self) {
            return by_name(self.mesh().patch_names, measure_volume(self.mesh()).patch_area_mm2);
          },
          "mm^2, by the names of patches.")
      .def_property_readonly(
          "layers", [](const VolumeObject& self) { return self.result.layers; }, "Of the lumen: LayerSummary.")
      .def_property_readonly(
          "wall_layers", [](const VolumeObject& self) { return self.result.shell; }, "Of the vessel's own wall.")
      .def_property_readonly(
          "defects", [](const VolumeObject& self) { return self.result.defects; },
          "What is wrong with it: VolumeDefect; none: it is sound.")
      .def_readonly("warnings", &VolumeObject::warnings, "Of the reader, one line each.")
      .def("with_branches", &with_branches, py::arg("centerline").none(false),
           "The same mesh with its regions divided by the branch of the nearest vessel: lumen_0, lumen_1 ..., numbers\n"
           "of Centerline.branches(). Raises InvalidInput for another vessel's centerline.")
      .def("save", &save_volume, py::arg("path"), py::kw_only(), py::arg("unit") = "mm", py::arg("space") = "LPS",
           py::arg("tetrahedra") = false,
           "Writes it by extension or the folder's name: .vtu, .msh, .msh4, .node (with .ele and .face), .inp,\n"
           "polyMesh, mesh-complete. Files and folders appear complete or not at all. tetrahedra: wedges and pyramids\n"
           "are split, for formats and solvers that have none. Raises WriteError, Unsupported.")
      .def(
          "to_vtk",
          [](const py::object& self) { return py::module_::import("vmesh._vtk").attr("volume_to_vtk")(self); },
          "A vtkUnstructuredGrid with ModelRegionID; needs VTK (Debian: python3-vtk9; pip install vtk).")
      .def(
          "to_pyvista",
          [](const py::object& self) { return py::module_::import("vmesh._vtk").attr("volume_to_pyvista")(self); },
          "A pyvista.UnstructuredGrid with ModelRegionID; needs PyVista (pip install pyvista).")
      .def("__repr__", &describe_volume);
}

LayerOptions layers_of(int count, double thickness, bool in_mm, double first_mm, double growth) {
  return {.count = count, .thickness = thickness, .in_mm = in_mm, .first_mm = first_mm, .growth = growth};
}

}  // namespace

void bind_solid(py::module_& module) {
  bind_volume_parts(module);
  bind_volume_mesh(module);
  module.def(
      "volume",
      [](const SurfacePtr& surface, const py::object& progress, int layers, double layer_thickness,
         bool layer_thickness_in_mm, double first_layer, double layer_growth, double core_size, int wall_layers,
         double wall_thickness, bool wall_thickness_in_mm, bool merge_walls, bool wall_only) {
        VolumeOptions options;
        options.layers = layers_of(layers, layer_thickness, layer_thickness_in_mm, first_layer, layer_growth);
        options.shell = layers_of(wall_layers, wall_thickness, wall_thickness_in_mm, 0, 1);
        options.shell.merged = merge_walls;
        options.shell_only = wall_only;
        options.core_size = core_size;
        return result_of(progress, [&](const Progress& report) { return make_volume_in(*surface, options, report); });
      },
      py::arg("surface").none(false), py::kw_only(), py::arg("progress"), py::arg("layers"), py::arg("layer_thickness"),
      py::arg("layer_thickness_in_mm"), py::arg("first_layer"), py::arg("layer_growth"), py::arg("core_size"),
      py::arg("wall_layers"), py::arg("wall_thickness"), py::arg("wall_thickness_in_mm"), py::arg("merge_walls"),
      py::arg("wall_only"), "vmesh.volume() without its checks.");
  module.def("read_volume", &read_volume_file, py::arg("path"),
             R"(Reads a volume mesh (.vtu) in mm and LPS: tetrahedra, wedges and pyramids, with regions and patches.

    path         the file; without patches, all of its outside is "wall"

Raises ReadError, InvalidInput, Unsupported.)");
}

}  // namespace vmesh::python

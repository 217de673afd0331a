#include <cmath>

#include <pybind11/stl/filesystem.h>

#include "vmesh/deform/linear_skin.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/quality/sampled_distance.h"
#include "vmesh/surface/branch_labels.h"
#include "vmesh/surface/surface_attributes.h"

#include "arrays.h"
#include "attributes.h"
#include "binding.h"
#include "module.h"
#include "text.h"

namespace vmesh::python {
namespace {

namespace fs = std::filesystem;

SurfacePtr surface_from_arrays(const py::object& vertices, const py::object& faces, const CenterlinePtr& centerline) {
  auto surface = std::make_shared<SurfaceObject>();
  surface->result.mesh = {to_points(vertices, "vertices"), to_triangles(faces, "faces")};
  const TriMesh& mesh = surface->mesh();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) {
      if (v >= mesh.vertices.size())
        throw InvalidInput("faces: row " + std::to_string(f) + " names vertex " + std::to_string(v) + "; there are " +
                           std::to_string(mesh.vertices.size()));
    }
  }
  const py::gil_scoped_release release;
  if (centerline) bind_to(*surface, centerline);
  return surface;
}

SurfacePtr read_surface_file(const fs::path& path, const CenterlinePtr& centerline,
                             const std::optional<std::string>& unit, const std::optional<std::string>& space) {
  std::optional<LengthUnit> unit_given;
  std::optional<Space> space_given;
  if (unit) unit_given = require_length_unit(*unit);
  if (space) space_given = require_space(*space);
  const py::gil_scoped_release release;
  LoadedSurface loaded = read_surface(path);
  convert_to_internal(loaded, path.string(), unit_given, space_given);
  auto surface = std::make_shared<SurfaceObject>();
  surface->result.mesh = std::move(loaded.mesh);
  surface->attributes = std::move(loaded.attributes);
  for (const MeshAttribute& attribute : surface->attributes.vertex) {
    if (attribute.name == "radius") surface->result.radius = attribute.values;
  }
  surface->warnings = std::move(loaded.warnings);
  if (centerline) bind_to(*surface, centerline);
  return surface;
}

void save_surface(const SurfaceObject& self, const fs::path& path, const std::string& unit, const std::string& space,
                  bool bones, bool ascii, bool compress) {
  SurfaceMetadata metadata;
  metadata.generator = generator_name();
  metadata.unit = require_length_unit(unit);
  metadata.space = require_space(space);
  if (bones && !self.centerline) throw InvalidInput("bones need a centerline, and this surface is not bound to one");
  if (ascii && compress) throw InvalidInput("ascii, compress: a file is one or the other");
  const py::gil_scoped_release release;
  std::optional<SurfaceSkin> skin;
  if (bones) {
    const Centerline& centerline = self.centerline->centerline;
    skin = make_linear_skin(centerline, make_rod_tree(centerline), places_of(self));
  }
  SurfaceWriteOptions options;
  if (ascii) options.encoding = SurfaceEncoding::text;
  if (compress) options.encoding = SurfaceEncoding::compressed;
  if (skin) options.skin = &*skin;
  write_surface(path, self.mesh(), attributes_of(self), metadata, options);
}

py::dict as_dict(const std::vector<MeshAttribute>& attributes) {
  py::dict result;
  for (const MeshAttribute& attribute : attributes) {
    result[py::str(attribute.name)] =
        attribute.integer ? array_of(std::vector<std::int64_t>(attribute.values.begin(), attribute.values.end()))
                          : array_of(std::vector<double>(attribute.values));
  }
  return result;
}

const GenerateResult& result_of(const py::object& self) { return self.cast<const SurfaceObject&>().result; }

/// None if the surface is not bound to a centerline.
template <class T>
py::object binding_view(const py::object& self, T CenterlineBinding::*member) {
  if (!self.cast<const SurfaceObject&>().centerline) return py::none();
  const std::vector<CenterlineBinding>& binding = result_of(self).binding;
  return member_view(binding, binding.empty() ? nullptr : &(binding.front().*member), self);
}

py::object radius_view(const py::object& self) {
  if (result_of(self).radius.empty()) return py::none();
  return vector_view(result_of(self).radius, self);
}

py::object branch_of(const SurfaceObject& self, std::vector<Index> BranchLabels::*of) {
  if (!self.centerline) return py::none();
  BranchLabels labels = label_branches(self.mesh(), self.result.binding, self.centerline->centerline);
  return array_of(std::move(labels.*of));
}

/// Faces as in VTK and PyVista: the number of corners, then the corners.
py::array padded_faces(const SurfaceObject& self) {
  std::vector<std::int64_t> cells;
  cells.reserve(4 * self.mesh().faces.size());
  for (const Triangle& face : self.mesh().faces) {
    cells.push_back(3);
    for (const Index v : face) cells.push_back(v);
  }
  const auto rows = static_cast<py::ssize_t>(self.mesh().faces.size());
  return array_of(std::move(cells)).attr("reshape")(rows, 4);
}

py::object volume_of(const SurfaceObject& self) {
  const Topology topology = measure_topology(self.mesh());
  if (!topology.closed || !topology.oriented) return py::none();
  return py::float_(enclosed_volume(self.mesh()));
}

py::array normals_of(const SurfaceObject& self) {
  std::vector<double> values;
  values.reserve(3 * self.mesh().vertices.size());
  for (const Vec3& n : vertex_normals(self.mesh())) values.insert(values.end(), n.data(), n.data() + 3);
  return array_of(std::move(values)).attr("reshape")(-1, 3);
}

std::string describe_surface(const SurfaceObject& self) {
  std::string text = "<vmesh.Surface: " + counted(self.mesh().vertices.size(), "vertex", "vertices") + ", ";
  text += counted(self.mesh().faces.size(), "face");
  if (self.result.openings.size() > 0) text += ", " + counted(self.result.openings.size(), "opening");
  if (!self.result.defects.empty()) text += ", " + counted(self.result.defects.size(), "defect");
  return text + ">";
}

void bind_parts(py::module_& module) {
  py::class_<Defect>(module, "Defect", "Something that a sound surface must not have.")
      .def_property_readonly(
          "kind", [](const Defect& d) { return std::string(to_string(d.kind)); },
          "not_closed, not_manifold, wrong_topology, inside_out, crossing_faces, bad_triangle or node_outside.")
      .def_property_readonly(
          "position", [](const Defect& d) { return array_of(d.position); }, "(3,) mm, one of them.")
      .def_readonly("count", &Defect::count, "Pairs of faces, faces, edges or nodes.")
      .def_property_readonly(
          "segment", [](const Defect& d) { return optional_index(d.segment); }, "Of the centerline, nearby, or None.")
      .def_property_readonly(
          "branch", [](const Defect& d) { return optional_index(d.branch); },
          "Of Centerline.branches(), nearby, or None.")
      .def_property_readonly(
          "node", [](const Defect& d) { return optional_index(d.node); }, "The nearest of the centerline, or None.")
      .def_readonly("message", &Defect::message, "A description with number and position.")
      .def("__repr__",
           [](const Defect& d) { return "<vmesh.Defect " + std::string(to_string(d.kind)) + ": " + d.message + ">"; });
  py::class_<Opening>(module, "Opening", "A hole at an end of a vessel.")
      .def_property_readonly(
          "node", [](const Opening& o) { return optional_index(o.node); },
          "Of the centerline; None where it is not known.")
      .def_property_readonly(
          "center", [](const Opening& o) { return array_of(o.center); }, "(3,) mm.")
      .def_property_readonly(
          "normal", [](const Opening& o) { return array_of(o.normal); }, "(3,) out of the vessel.")
      .def_readonly("radius", &Opening::radius, "Of the vessel there, mm.")
      .def_property_readonly(
          "ring", [](const py::object& self) { return vector_view(self.cast<const Opening&>().ring, self); },
          "Its vertices, (k,) uint32, counter-clockwise about the normal.");
  py::class_<FlatEnd>(module, "FlatEnd", "An end of a vessel where the surface ends flat.")
      .def_readonly("label", &FlatEnd::label, "In Surface.cap_label: the end's rank among all ends, from 1.")
      .def_readonly("node", &FlatEnd::node, "Of the centerline.")
      .def_property_readonly(
          "center", [](const FlatEnd& e) { return array_of(e.center); }, "(3,) mm.")
      .def_property_readonly(
          "normal", [](const FlatEnd& e) { return array_of(e.normal); }, "(3,) out of the vessel.")
      .def_readonly("area", &FlatEnd::area, "Of the cross-section, mm^2.")
      .def_readonly("capped", &FlatEnd::capped, "Else it is open.")
      .def_readonly("extension", &FlatEnd::extension, "Its length, in radii of the circle of that area; 0: none.");
  py::class_<OperatingPoint>(module, "OperatingPoint", "Options that were tried to keep within a budget.")
      .def_property_readonly(
          "around", [](const OperatingPoint& p) { return p.options.around; }, "Vertices around a vessel.")
      .def_readonly("vertices", &OperatingPoint::vertices, "Of the surface.")
      .def_readonly("seconds", &OperatingPoint::seconds, "That growth took.")
      .def_property_readonly(
          "mean_error", [](const OperatingPoint& p) { return p.error.mean_mm; },
          "Of the faces' distance to the vessels' boundary, mm.")
      .def_property_readonly(
          "max_error", [](const OperatingPoint& p) { return p.error.max_mm; }, "The same at most, mm.")
      .def_readonly("within_budget", &OperatingPoint::within_budget, "Whether the surface keeps to it.");
}

void bind_arrays(py::class_<SurfaceObject, SurfacePtr>& surface) {
  surface
      .def_property_readonly(
          "vertices", [](const py::object& self) { return points_view(result_of(self).mesh.vertices, self); },
          "Positions, (n, 3) float64, mm, LPS. A view, not writable.")
      .def_property_readonly(
          "faces", [](const py::object& self) { return triangles_view(result_of(self).mesh.faces, self); },
          "Corners, (m, 3) uint32, counter-clockwise seen from outside. A view, not writable.")
      .def_property_readonly(
          "segment", [](const py::object& self) { return binding_view(self, &CenterlineBinding::segment); },
          "Of the centerline, that every vertex belongs to, (n,) uint32; isolated nodes are numbered after\n"
          "the segments. None if the surface is not bound to a centerline. A view, not writable.")
      .def_property_readonly(
          "parameter", [](const py::object& self) { return binding_view(self, &CenterlineBinding::t); },
          "Where on that segment, (n,) float64 in [0, 1] from its first node to its second, or None. A\n"
          "view, not writable.")
      .def_property_readonly(
          "radius", &radius_view,
          "Radius of the vessel at that place, or as the file has it, (n,) float64, mm, or None. A view,\n"
          "not writable.")
      .def_property_readonly(
          "branch", [](const SurfaceObject& self) { return branch_of(self, &BranchLabels::vertex); },
          "Index into centerline.branches() of every vertex, (n,) uint32, or None. Made anew each time.")
      .def_property_readonly(
          "face_branch", [](const SurfaceObject& self) { return branch_of(self, &BranchLabels::face); },
          "The same for every face, (m,) uint32.")
      .def_property_readonly(
          "skewness", [](const SurfaceObject& self) { return array_of(equiangle_skewness(self.mesh())); },
          "Equiangle skewness of every face, (m,) float64: 0 equilateral, 1 degenerate. Made anew each time.")
      .def_property_readonly(
          "cap_label",
          [](const py::object& self) { return vector_view(self.cast<const SurfaceObject&>().ends.cap_label, self); },
          "Of every face the FlatEnd.label that it caps, (m,) uint32, 0 for the wall; empty without flat ends.")
      .def_property_readonly("normals", &normals_of,
                             "Unit normals of the vertices, weighted by area, (n, 3) float64. Made anew each time.")
      .def("padded_faces", &padded_faces,
           "(m, 4) int64: 3, then the corners. PyVista: pyvista.PolyData(surface.vertices, surface.padded_faces()).");
}

}  // namespace

MeshAttributes attributes_of(const SurfaceObject& self) {
  if (!self.centerline) return self.attributes;
  const GenerateResult& r = self.result;
  MeshAttributes attributes = surface_attributes(r.mesh, r.binding, r.radius, r.openings, self.centerline->centerline);
  if (!self.ends.ends.empty()) add_cap_labels(self.ends, attributes);
  return attributes;
}

void bind_surface(py::module_& module) {
  bind_parts(module);
  py::class_<SurfaceObject, SurfacePtr> surface(module, "Surface", R"(A triangle mesh, and what is known of it.

Where it is bound to a centerline every vertex knows its place on it. A surface never changes: its
arrays are views of its memory, not writable, and keep it alive.

Surface(vertices, faces, centerline=None) takes arrays (copied): (n, 3) floats, mm, LPS, and (m, 3)
whole numbers. With a centerline every vertex is bound to the nearest place on it.)");
  surface.def(py::init(&surface_from_arrays), py::arg("vertices"), py::arg("faces"), py::arg("centerline") = py::none())
      .def_property_readonly(
          "centerline", [](const SurfaceObject& self) { return self.centerline; },
          "The centerline that it is bound to, or None.")
      .def_property_readonly(
          "openings", [](const SurfaceObject& self) { return self.result.openings; }, "Holes at ends of vessels.")
      .def_property_readonly(
          "flat_ends", [](const SurfaceObject& self) { return self.ends.ends; }, "Ends that were finished flat.")
      .def_property_readonly(
          "defects", [](const SurfaceObject& self) { return self.result.defects; },
          "What is wrong with a surface that was grown or fitted; none: it is sound. For others see\n"
          "evaluate().")
      .def_readonly("warnings", &SurfaceObject::warnings, "What a user should know about it, one line each.")
      .def_property_readonly(
          "unproven_faces", [](const SurfaceObject& self) { return self.result.error.unproven_faces; },
          "Faces for which max_error is not proven.")
      .def_property_readonly(
          "stages",
          [](const SurfaceObject& self) {
            py::dict seconds;
            for (const StageTime& stage : self.result.stages) seconds[py::str(stage.stage)] = stage.seconds;
            return seconds;
          },
          "Seconds that growth took, by stage.")
      .def_readonly("tried", &SurfaceObject::tried,
                    "What generate() tried to keep within a budget, by `around`; empty without a budget.")
      .def_readonly("fit_report", &SurfaceObject::fit, "What fit() did, or None.")
      .def_property_readonly(
          "area", [](const SurfaceObject& self) { return surface_area(self.mesh()); }, "mm^2.")
      .def_property_readonly("volume", &volume_of, "Enclosed, mm^3; None unless the surface is closed and oriented.")
      .def_property_readonly(
          "vertex_attributes", [](const SurfaceObject& self) { return as_dict(attributes_of(self).vertex); },
          "Arrays by name, (n,) each: those of a file, or radius, segment, parameter, branch (opening).")
      .def_property_readonly(
          "face_attributes", [](const SurfaceObject& self) { return as_dict(attributes_of(self).face); },
          "Arrays by name, (m,) each: those of a file, or EquiangleSkewness and branch.")
      .def("save", &save_surface, py::arg("path"), py::kw_only(), py::arg("unit") = "mm", py::arg("space") = "LPS",
           py::arg("bones") = false, py::arg("ascii") = false, py::arg("compress") = false,
           "Writes it by extension: .ply, .vtp, .glb, .obj, .stl, .off. The file appears complete or not at all.\n"
           "bones: a .glb gets some along the centerline. ascii: .ply and .stl as text. compress: a .glb packed by\n"
           "EXT_meshopt_compression, with positions rounded to a millionth of the size. Raises WriteError,\n"
           "Unsupported.")
      .def(
          "to_vtk", [](const py::object& self) { return py::module_::import("vmesh._vtk").attr("to_vtk")(self); },
          "A vtkPolyData with the attributes as arrays; needs VTK (Debian: python3-vtk9; pip install vtk).")
      .def(
          "to_pyvista",
          [](const py::object& self) { return py::module_::import("vmesh._vtk").attr("to_pyvista")(self); },
          "A pyvista.PolyData with the attributes as arrays; needs PyVista (pip install pyvista).")
      .def(
          "to_trimesh",
          [](const py::object& self) { return py::module_::import("vmesh._trimesh").attr("to_trimesh")(self); },
          "A trimesh.Trimesh with the attributes, vertices and faces as they are; needs trimesh (pip install trimesh).")
      .def(
          "_repr_html_",
          [](const py::object& self) { return py::module_::import("vmesh._notebook").attr("shown")(self); },
          "The page (vmesh.page) for notebooks; None, so that they show the text, without pages or for large ones.")
      .def("__repr__", &describe_surface);
  bind_arrays(surface);
  module.def("read_surface", &read_surface_file, py::arg("path"), py::kw_only(), py::arg("centerline") = py::none(),
             py::arg("unit") = py::none(), py::arg("space") = py::none(),
             R"(Reads a surface by extension: .ply, .vtp, .vtk, .stl, .obj, .off, .glb, .gltf, .3mf, .dae, .x3d, .fbx.

    path         the file
    centerline   what it was grown around: vertices are bound as the file says (.ply and .vtp that
                 vmesh wrote), or to the nearest place
    unit, space  win over what the file says: nm, um, mm, cm, m; LPS, RAS

Raises ReadError, InvalidInput, Unsupported.)");
}

}  // namespace vmesh::python

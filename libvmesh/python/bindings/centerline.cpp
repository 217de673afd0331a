#include <variant>

#include <pybind11/stl/filesystem.h>

#include "vmesh/centerline/branches.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/synth/synthetic_tree.h"

#include "arrays.h"
#include "module.h"
#include "objects.h"
#include "text.h"

namespace vmesh::python {
namespace {

namespace fs = std::filesystem;

std::vector<CenterlineNode> nodes_from(const py::object& nodes, const py::object& radii) {
  const std::vector<Vec3> points = to_points(nodes, "nodes");
  const std::vector<double> radius = to_numbers(radii, "radii", points.size());
  std::vector<CenterlineNode> result;
  result.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) result.push_back({points[i], radius[i]});
  return result;
}

std::vector<CenterlineSegment> segments_from(const py::object& segments) {
  std::vector<CenterlineSegment> result;
  for (const auto& [a, b] : to_pairs(segments, "segments")) result.push_back({a, b});
  return result;
}

CenterlinePtr from_arrays(const py::object& nodes, const py::object& radii, const py::object& segments) {
  return std::make_shared<CenterlineObject>(
      CenterlineObject{Centerline(nodes_from(nodes, radii), segments_from(segments)), {}, {}, {}});
}

CleaningOptions cleaning_options(double tolerance, double overlap_tolerance, std::optional<bool> join_gaps, bool round,
                                 bool canonical_order) {
  CleaningOptions options;
  options.tolerance = tolerance;
  options.overlap_tolerance = overlap_tolerance;
  options.join_gaps = join_gaps;
  options.round = round;
  options.canonical_order = canonical_order;
  return options;
}

std::vector<std::string> messages_of(const CleaningReport& report) {
  std::vector<std::string> lines;
  for (const CleaningAction& action : report.actions) lines.push_back(action.message);
  return lines;
}

CenterlinePtr clean_arrays(const py::object& nodes, const py::object& radii, const py::object& segments,
                           const std::string& unit, const std::string& space, const CleaningOptions& options) {
  RawCenterline raw;
  raw.nodes = nodes_from(nodes, radii);
  raw.segments = segments_from(segments);
  raw.unit = require_length_unit(unit);
  raw.space = require_space(space);
  raw.source = "arrays";
  const py::gil_scoped_release release;
  std::vector<std::string> warnings;
  CleanedCenterline cleaned = clean(convert_to_internal(std::move(raw), std::nullopt, std::nullopt, warnings), options);
  return std::make_shared<CenterlineObject>(
      CenterlineObject{std::move(cleaned.centerline), messages_of(cleaned.report), std::move(warnings), {}});
}

CenterlinePtr read(const std::vector<fs::path>& paths, const CenterlineLoadOptions& options) {
  const py::gil_scoped_release release;
  LoadedCenterline loaded = load_centerline(paths, options);
  std::vector<std::string> places;
  for (const Index raw : loaded.cleaned.raw_node) places.push_back(loaded.file.place_of_node(raw));
  return std::make_shared<CenterlineObject>(
      CenterlineObject{std::move(loaded.cleaned.centerline), messages_of(loaded.cleaned.report),
                       std::move(loaded.warnings), std::move(places), std::move(loaded.cleaned.end_sections)});
}

py::array nodes_view(const py::object& self) {
  const std::vector<CenterlineNode>& nodes = self.cast<const CenterlineObject&>().centerline.nodes();
  return view(nodes.empty() ? nullptr : nodes.front().position.data(), {static_cast<py::ssize_t>(nodes.size()), 3},
              {sizeof(CenterlineNode), sizeof(double)}, self);
}

py::array radii_view(const py::object& self) {
  const std::vector<CenterlineNode>& nodes = self.cast<const CenterlineObject&>().centerline.nodes();
  return member_view(nodes, nodes.empty() ? nullptr : &nodes.front().radius, self);
}

py::array segments_view(const py::object& self) {
  const std::vector<CenterlineSegment>& segments = self.cast<const CenterlineObject&>().centerline.segments();
  return view(segments.empty() ? nullptr : &segments.front().a, {static_cast<py::ssize_t>(segments.size()), 2},
              {sizeof(CenterlineSegment), sizeof(Index)}, self);
}

std::vector<py::array> branches_of(const CenterlineObject& self) {
  std::vector<py::array> result;
  for (Branch& branch : find_branches(self.centerline)) result.push_back(array_of(std::move(branch.nodes)));
  return result;
}

void save(const CenterlineObject& self, const fs::path& path, const std::string& unit, const std::string& space) {
  CenterlineMetadata metadata;
  metadata.generator = generator_name();
  metadata.unit = require_length_unit(unit);
  metadata.space = require_space(space);
  const py::gil_scoped_release release;
  write_centerline(path, self.centerline, metadata, self.end_sections);
}

/// (n, 3), a copy.
py::array ring_of(const EndSection& section) {
  py::array_t<double> points({static_cast<py::ssize_t>(section.ring.size()), py::ssize_t{3}});
  for (std::size_t i = 0; i < section.ring.size(); ++i) {
    for (py::ssize_t axis = 0; axis < 3; ++axis)
      points.mutable_at(static_cast<py::ssize_t>(i), axis) = section.ring[i][axis];
  }
  return points;
}

py::list sections_of(const CenterlineObject& self) {
  py::list list;
  for (const EndSection& section : self.end_sections) {
    py::dict entry;
    entry["node"] = section.node;
    entry["center"] = array_of(section.center);
    entry["normal"] = array_of(section.normal);
    entry["area"] = section.area;
    entry["open"] = section.open;
    entry["ring"] = section.ring.empty() ? py::object(py::none()) : py::object(ring_of(section));
    list.append(entry);
  }
  return list;
}

/// The reverse, for pickles.
std::vector<EndSection> sections_from(const py::list& list) {
  std::vector<EndSection> sections;
  for (const py::handle& entry : list) {
    EndSection section{entry["node"].cast<Index>(),
                       to_point(entry["center"], "center"),
                       to_point(entry["normal"], "normal"),
                       entry["area"].cast<double>(),
                       {},
                       entry["open"].cast<bool>()};
    if (!entry["ring"].is_none()) section.ring = to_points(entry["ring"], "ring");
    sections.push_back(std::move(section));
  }
  return sections;
}

std::string describe(const CenterlineObject& self) {
  const Centerline& c = self.centerline;
  return "<vmesh.Centerline: " + counted(c.nodes().size(), "node") + ", " + counted(c.segments().size(), "segment") +
         ", " + counted(c.component_count(), "component") + ", " + counted(c.cycle_rank(), "loop") + ">";
}

void bind_class(py::module_& module) {
  py::class_<CenterlineObject, CenterlinePtr>(module, "Centerline", R"(Points with radii, and the segments between them.

The vessel around a segment is the convex hull of the spheres at its two nodes. Loops, several
components and nodes without a segment (spheres) are allowed. A centerline never changes.

Centerline(nodes, radii, segments) takes arrays as they are:
    nodes     (n, 3) floats, mm, LPS
    radii     (n,) floats, mm, above 0
    segments  (m, 2) whole numbers: the two nodes of every segment, no pair twice
Arrays are copied. Raises InvalidInput that lists what is wrong; clean() mends that.)")
      .def(py::init(&from_arrays), py::arg("nodes"), py::arg("radii"), py::arg("segments"))
      .def_property_readonly("nodes", &nodes_view, "Positions, (n, 3) float64, mm, LPS. A view, not writable.")
      .def_property_readonly("radii", &radii_view, "Radii, (n,) float64, mm. A view, not writable.")
      .def_property_readonly("segments", &segments_view,
                             "The two nodes of every segment, (m, 2) uint32. A view, not writable.")
      .def_property_readonly(
          "component_of_node",
          [](const py::object& self) {
            return vector_view(self.cast<const CenterlineObject&>().centerline.component_of_node(), self);
          },
          "Number of the component of every node, (n,) uint32. A view, not writable.")
      .def_property_readonly(
          "components", [](const CenterlineObject& self) { return self.centerline.component_count(); },
          "Number of connected components.")
      .def_property_readonly(
          "loops", [](const CenterlineObject& self) { return self.centerline.cycle_rank(); },
          "Independent loops; 0 for a forest.")
      .def_property_readonly(
          "length_in_radii", [](const CenterlineObject& self) { return self.centerline.length_in_radii(); },
          "Sum of length / mean radius over the segments: the size of the meshing task, independent of scale.")
      .def_property_readonly("end_sections", &sections_of,
                             "Flat ends, where the file says how vessels are cut (.json, .vtp): a list of dicts with\n"
                             "node, center (3,), normal (3,) out of the vessel, area, open, and ring (n, 3) about the\n"
                             "normal or None; mm, LPS. Ends of generate(ends=\"flat\") and \"open\" get them exactly.")
      .def_readonly("cleaning", &CenterlineObject::cleaning, "What cleaning did, one line each.")
      .def_readonly("warnings", &CenterlineObject::warnings,
                    "What was assumed because the file does not say, one line each.")
      .def("branches", &branches_of,
           "The nodes of every branch, (k,) uint32 each: stretches between nodes where vessels branch or end. The "
           "labels\n"
           "of Surface.branch are indices into this list.")
      .def("save", &save, py::arg("path"), py::kw_only(), py::arg("unit") = "mm", py::arg("space") = "LPS",
           "Writes it by extension: .json, .swc, .vtp, .csv. The file appears complete or not at all. Raises "
           "WriteError,\n"
           "and Unsupported for loops in .swc.")
      .def("__repr__", &describe)
      .def(py::pickle(
          [](const py::object& self) {
            return py::make_tuple(self.attr("nodes"), self.attr("radii"), self.attr("segments"), self.attr("cleaning"),
                                  self.attr("warnings"), self.attr("end_sections"));
          },
          [](const py::tuple& state) {
            CenterlinePtr centerline = from_arrays(state[0], state[1], state[2]);
            centerline->cleaning = state[3].cast<std::vector<std::string>>();
            centerline->warnings = state[4].cast<std::vector<std::string>>();
            centerline->end_sections = sections_from(state[5]);
            return centerline;
          }));
}

/// A tolerance in radii.
EndTolerance radii_of(double radii) {
  if (!(radii > 0 && radii <= 1e9))
    throw InvalidInput("join_ends: radii above 0 are needed, or text such as \"0.5mm\"");
  return {0, radii};
}

}  // namespace

void bind_centerline(py::module_& module) {
  bind_class(module);
  const CleaningOptions plain;
  module.def(
      "clean",
      [](const py::object& nodes, const py::object& radii, const py::object& segments, const std::string& unit,
         const std::string& space, double tolerance, double overlap_tolerance, std::optional<bool> join_gaps,
         bool round, bool canonical_order) {
        return clean_arrays(nodes, radii, segments, unit, space,
                            cleaning_options(tolerance, overlap_tolerance, join_gaps, round, canonical_order));
      },
      py::arg("nodes"), py::arg("radii"), py::arg("segments"), py::kw_only(), py::arg("unit") = "mm",
      py::arg("space") = "LPS", py::arg("tolerance") = plain.tolerance,
      py::arg("overlap_tolerance") = plain.overlap_tolerance, py::arg("join_gaps") = py::none(),
      py::arg("round") = plain.round, py::arg("canonical_order") = plain.canonical_order,
      R"(A valid centerline from arrays that may not be: nodes at one place are merged, segments of no
length contracted, missing radii (0) interpolated along the graph; `Centerline.cleaning` says what
was done.

    nodes, radii, segments  as for Centerline, in `unit` (nm, um, mm, cm, m) and `space` (LPS, RAS)
    tolerance               points closer than this times the smaller radius count as one
    overlap_tolerance       polylines that begin in one place count as one while they differ by less
                            than this times the radius
    join_gaps               join loose ends to the node of another component within its radius
    round                   to a decimal grid of 1e-6 mm or finer
    canonical_order         number nodes by geometry alone; False keeps the order given

Raises InvalidInput that names the node for numbers that are not finite, negative radii, unknown
nodes.)");
  module.def(
      "read_centerline",
      [](const std::variant<fs::path, std::vector<fs::path>>& path, const std::optional<std::string>& unit,
         const std::optional<std::string>& space, const std::string& radius_array, std::optional<double> radius,
         const py::object& voxel_size, const std::variant<std::monostate, double, std::string>& join_ends,
         double tolerance, double overlap_tolerance, std::optional<bool> join_gaps, bool round, bool canonical_order) {
        CenterlineLoadOptions options;
        options.read.radius_array = radius_array;
        options.read.radius = radius;
        if (!voxel_size.is_none()) options.read.voxel_size = to_point(voxel_size, "voxel_size");
        if (const auto* radii = std::get_if<double>(&join_ends)) options.read.tolerance = radii_of(*radii);
        if (const auto* text = std::get_if<std::string>(&join_ends))
          options.read.tolerance = parse_end_tolerance(*text);
        if (unit) options.unit = require_length_unit(*unit);
        if (space) options.space = require_space(*space);
        options.cleaning = cleaning_options(tolerance, overlap_tolerance, join_gaps, round, canonical_order);
        const auto* one = std::get_if<fs::path>(&path);
        return read(one != nullptr ? std::vector<fs::path>{*one} : std::get<std::vector<fs::path>>(path), options);
      },
      py::arg("path"), py::kw_only(), py::arg("unit") = py::none(), py::arg("space") = py::none(),
      py::arg("radius_array") = "", py::arg("radius") = py::none(), py::arg("voxel_size") = py::none(),
      py::arg("join_ends") = py::none(), py::arg("tolerance") = plain.tolerance,
      py::arg("overlap_tolerance") = plain.overlap_tolerance, py::arg("join_gaps") = py::none(),
      py::arg("round") = plain.round, py::arg("canonical_order") = plain.canonical_order,
      R"(Reads a centerline by extension (.swc, .vtp, .json, .csv, .vmv, .vtk, .ctgr, .gxl, .am, .dat, .h5
...) and cleans it. Several paths make one centerline.

    path          a file, or several
    unit, space   win over what the file says: nm, um, mm, cm, m; LPS, RAS
    radius_array  .vtp, .vtk, .csv, .am: the array of radii, diameters or areas
    radius        mm, for files without radii
    voxel_size    (3,), sides of the voxels in which the file counts: .gxl (in the unit of the radii), .swc (all equal)
    join_ends     join ends of branches that are nearer to each other than this: "0.5mm", or 0.1 of their radius; the
                  --tolerance of the command
    tolerance, overlap_tolerance, join_gaps, round, canonical_order
                  as for clean()

Raises ReadError, InvalidInput that names file and line, Unsupported.)");
  module.def(
      "synthetic_tree",
      [](std::size_t vertices, std::uint64_t seed) {
        return std::make_shared<CenterlineObject>(CenterlineObject{synthetic_tree({vertices, seed}), {}, {}, {}});
      },
      py::arg("vertices") = SyntheticTreeOptions().vertices, py::arg("seed") = SyntheticTreeOptions().seed,
      "A tree like a liver's portal vein, of exactly `vertices` nodes, 2 to 10,000,000, in mm. A `seed` gives the same "
      "tree always.");
}

}  // namespace vmesh::python

#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "arrays.h"
#include "deformation.h"
#include "text.h"

namespace vmesh::python {
namespace {

SimulationOptions options_of(double step, int iterations, const py::object& gravity, double drag,
                             double squeeze_response, double rest_tolerance) {
  SimulationOptions options;
  options.step_s = step;
  options.iterations = iterations;
  options.gravity_mm_s2 = to_point(gravity, "gravity_mm_s2");
  options.drag_per_s = drag;
  options.squeeze_response_s = squeeze_response;
  options.rest_tolerance = rest_tolerance;
  return options;
}

/// Steps, with a call after each.
StepReport step_with(Deformation& self, std::size_t count, const py::function& then) {
  StepReport last;
  for (std::size_t i = 0; i < count; ++i) {
    {
      const py::gil_scoped_release release;
      last = self.advance();
      self.synchronise();
    }
    then();
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return last;
}

/// Steps, checking for signals now and then.
StepReport step(Deformation& self, std::size_t count, const std::optional<py::function>& then) {
  if (then) return step_with(self, count, *then);
  constexpr std::chrono::milliseconds kBetweenLooks(50);
  StepReport last;
  std::size_t done = 0;
  while (done < count) {
    {
      const py::gil_scoped_release release;
      const auto until = std::chrono::steady_clock::now() + kBetweenLooks;
      do last = self.advance();
      while (++done < count && std::chrono::steady_clock::now() < until);
      self.synchronise();
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return last;
}

template <class T>
bool write_as(const std::vector<Vec3>& vertices, py::array& out) {
  if (!py::isinstance<py::array_t<T, py::array::c_style>>(out)) return false;
  T* to = static_cast<T*>(out.mutable_data());  // throws if it is not writable
  for (const Vec3& p : vertices) {
    for (const double x : p) *to++ = static_cast<T>(x);
  }
  return true;
}

// Any other array would be copied, and the result lost.
void write_into(const Deformation& self, py::array& out) {
  const std::vector<Vec3>& vertices = self.vertices();
  if (out.ndim() != 2 || static_cast<std::size_t>(out.shape(0)) != vertices.size() || out.shape(1) != 3)
    throw InvalidInput("out: the shape is not (" + std::to_string(vertices.size()) + ", 3)");
  if (!write_as<float>(vertices, out) && !write_as<double>(vertices, out))
    throw InvalidInput("out: an array of float32 or float64 in C order is needed");
}

SurfacePtr as_surface(const Deformation& self) {
  auto surface = std::make_shared<SurfaceObject>();
  surface->result.mesh = {self.vertices(), self.surface()->mesh().faces};
  surface->attributes.vertex.push_back({"displacement", {}});
  const std::vector<Vec3>& rest = self.surface()->mesh().vertices;
  for (std::size_t v = 0; v < rest.size(); ++v)
    surface->attributes.vertex.back().values.push_back((self.vertices()[v] - rest[v]).norm());
  return surface;
}

using DeformationClass = py::class_<Deformation, std::shared_ptr<Deformation>>;

void bind_actions(DeformationClass& deformation) {
  deformation
      .def(
          "fix", [](Deformation& d, Index node) { d.simulation().fix(node); }, py::arg("node"),
          "Holds the position of a node; it may rotate.")
      .def(
          "clamp", [](Deformation& d, Index node) { d.simulation().clamp(node); }, py::arg("node"),
          "Holds the position of a node and its direction.")
      .def(
          "release", [](Deformation& d, Index node) { d.simulation().release(node); }, py::arg("node"),
          "Undoes fix(), clamp() and drag().")
      .def(
          "drag",
          [](Deformation& d, Index node, const py::object& to) { d.simulation().drag(node, to_point(to, "position")); },
          py::arg("node"), py::arg("position"), "The next step moves a node there, (3,) mm; then it is fixed.")
      .def(
          "set_force",
          [](Deformation& d, Index node, const py::object& f) {
            d.simulation().set_force(node, to_point(f, "force_N"));
          },
          py::arg("node"), py::arg("force_N"), "Sets the force on a node, (3,) N, until it is set again.")
      .def(
          "set_torque",
          [](Deformation& d, Index node, const py::object& t) {
            d.simulation().set_torque(node, to_point(t, "torque_N_mm"));
          },
          py::arg("node"), py::arg("torque_N_mm"), "Sets the torque on a node, (3,) N mm, until it is set again.")
      .def(
          "set_radial_scale",
          [](Deformation& d, Index node, double scale) { d.simulation().set_radial_scale(node, scale); },
          py::arg("node"), py::arg("scale"), "Sets the scale of the vessel's profile at a node, above 0.")
      .def(
          "set_squeeze", [](Deformation& d, Index node, double force) { d.simulation().set_squeeze(node, force); },
          py::arg("node"), py::arg("force_N"), "Presses evenly on the wall around a node, N; negative forces widen it.")
      .def(
          "set_velocity",
          [](Deformation& d, Index node, const py::object& v) {
            d.simulation().set_velocity(node, to_point(v, "velocity_mm_s"));
          },
          py::arg("node"), py::arg("velocity_mm_s"), "Sets the velocity of a node, (3,) mm/s.")
      .def(
          "cut",
          [](Deformation& d, Index segment, double parameter) {
            const auto ends = d.cut(cut_centerline(centerline_of(*d.surface()), {segment, parameter}));
            return py::make_tuple(ends[0], ends[1]);
          },
          py::arg("segment"), py::arg("parameter"),
          "Cuts the vessel across a segment of rest.centerline, at a parameter from 0 to 1 along it, and the surface "
          "with two flat caps. Nothing moves; vertices, faces, nodes and segments keep their numbers, new ones come "
          "last. `rest` and all arrays are new; views of those before stay as they are. Returns the two nodes at the "
          "cut.")
      .def(
          "clip",
          [](Deformation& d, Index segment, double parameter, double width, double scale, double closing) {
            return d.clip({segment, parameter}, Clip{width, scale}, closing);
          },
          py::arg("segment"), py::arg("parameter"), py::kw_only(), py::arg("width_mm") = Clip{}.width_mm,
          py::arg("scale") = Clip{}.scale, py::arg("closing_s") = 0.2,
          "Narrows the vessel at a place, given as for cut(): its profile goes to `scale` over `width_mm` (0: the "
          "radius) within `closing_s` of the following steps, and stays so. New nodes come last; `rest` and all arrays "
          "are new. Returns the nodes at which the profile narrows.")
      .def(
          "set_gravity",
          [](Deformation& d, const py::object& g) { d.simulation().set_gravity(to_point(g, "gravity_mm_s2")); },
          py::arg("gravity_mm_s2"), "(3,) mm/s^2.");
}

InstrumentPose pose_of(const py::object& position, const std::array<double, 4>& rotation) {
  InstrumentPose pose;
  pose.position_mm = to_point(position, "position");
  pose.rotation = Eigen::Quaterniond(rotation[0], rotation[1], rotation[2], rotation[3]);
  if (!(std::abs(pose.rotation.norm() - 1) < 1e-3)) throw InvalidInput("rotation: a quaternion of length 1 is needed");
  pose.rotation.normalize();
  return pose;
}

constexpr std::array<double, 4> kUpright{1, 0, 0, 0};

InstrumentShape shape_of(const std::vector<std::array<double, 3>>& points, const py::object& radius, double friction) {
  InstrumentShape shape;
  for (const auto& [x, y, z] : points) shape.points_mm.emplace_back(x, y, z);
  if (py::isinstance<py::float_>(radius) || py::isinstance<py::int_>(radius))
    shape.radii_mm.assign(points.size(), radius.cast<double>());
  else
    shape.radii_mm = radius.cast<std::vector<double>>();
  shape.friction = friction;
  return shape;
}

void bind_hands(DeformationClass& deformation) {
  deformation
      .def(
          "set_contact",
          [](Deformation& d, bool self, double friction, double gap_ratio, int iterations) {
            ContactOptions options;
            options.self = self, options.friction = friction, options.gap_ratio = gap_ratio;
            options.iterations = iterations;
            d.simulation().set_contact(options);
          },
          py::kw_only(), py::arg("self_contact") = false, py::arg("friction") = 0.0,
          py::arg("gap_ratio") = ContactOptions{}.gap_ratio, py::arg("iterations") = ContactOptions{}.iterations,
          "How things touch: whether vessels touch vessels, with which friction, and from which gap on, in radii.")
      .def(
          "add_instrument",
          [](Deformation& d, const std::vector<std::array<double, 3>>& points, const py::object& radius,
             const py::object& position, const std::array<double, 4>& rotation, double friction) {
            return d.simulation().add_instrument(shape_of(points, radius, friction), pose_of(position, rotation));
          },
          py::arg("points"), py::arg("radius"), py::arg("position"), py::kw_only(), py::arg("rotation") = kUpright,
          py::arg("friction") = 0.0,
          "A chain of round cones that pushes vessels: points (k, 3) mm in its own frame, radius one or k, mm; the "
          "frame's position (3,) mm and rotation, a quaternion (w, x, y, z). Returns its number.")
      .def(
          "move_instrument",
          [](Deformation& d, Index instrument, const py::object& position, const std::array<double, 4>& rotation) {
            d.simulation().move_instrument(instrument, pose_of(position, rotation));
          },
          py::arg("instrument"), py::arg("position"), py::arg("rotation") = kUpright,
          "The next step moves it there, as far as there is room.")
      .def(
          "grasp",
          [](Deformation& d, Index segment, double t, double slips) { return d.simulation().grasp(segment, t, slips); },
          py::arg("segment"), py::arg("parameter"), py::arg("slips_N") = std::numeric_limits<double>::infinity(),
          "Jaws close on a segment at a parameter, 0 to 1; above slips_N the vessel slips through them. Returns their "
          "number.")
      .def(
          "move_jaw",
          [](Deformation& d, Index jaw, const py::object& to) {
            d.simulation().move_jaw(jaw, to_point(to, "position"));
          },
          py::arg("jaw"), py::arg("position"), "The next step moves jaws there, (3,) mm.")
      .def(
          "open_jaw", [](Deformation& d, Index jaw) { d.simulation().open_jaw(jaw); }, py::arg("jaw"),
          "Lets go of the vessel.")
      .def(
          "jaw_position", [](Deformation& d, Index jaw) { return array_of(d.simulation().jaw_position(jaw)); },
          py::arg("jaw"), "Where jaws are, (3,) mm.")
      .def(
          "set_tissue",
          [](Deformation& d, Index segment, double stiffness, double tear) {
            d.simulation().set_tissue(segment, {stiffness, tear});
          },
          py::arg("segment"), py::arg("stiffness_N_mm2"),
          py::arg("tear_N_mm") = std::numeric_limits<double>::infinity(),
          "Springs along a segment to where it rests, which tear above a force per mm.")
      .def(
          "drag_force", [](Deformation& d, Index node) { return d.simulation().drag_force(node); }, py::arg("node"),
          "What pulls at the hand that drags a node.")
      .def(
          "instrument_force", [](Deformation& d, Index i) { return d.simulation().instrument_force(i); },
          py::arg("instrument"), "What pulls at the hand that holds an instrument.")
      .def(
          "jaw_force", [](Deformation& d, Index jaw) { return d.simulation().jaw_force(jaw); }, py::arg("jaw"),
          "What pulls at jaws.")
      .def_property_readonly(
          "contact_energy", [](Deformation& d) { return d.simulation().contact_energy_J(); },
          "In contacts, jaws and tissue, J.")
      .def_property_readonly(
          "torn", [](Deformation& d) { return d.simulation().torn(); }, "Nodes whose tissue tore.");
}

void bind_state(DeformationClass& deformation) {
  deformation
      .def_property_readonly(
          "vertices",
          [](const py::object& self) { return points_view(self.cast<const Deformation&>().vertices(), self); },
          "Positions of the vertices, (n, 3) float64, mm: a view that every step() changes. Copy it to keep it.")
      .def_property_readonly(
          "normals",
          [](const py::object& self) { return points_view(self.cast<const Deformation&>().normals(), self); },
          "Unit normals of the vertices, (n, 3) float64; also changes with every step().")
      .def_property_readonly(
          "nodes", [](const py::object& self) { return points_view(self.cast<const Deformation&>().nodes(), self); },
          "Positions of the centerline's nodes, (k, 3) float64, mm; also changes with every step().")
      .def_property_readonly(
          "faces", [](const Deformation& d) { return py::cast(d.surface()).attr("faces"); },
          "Of the surface, (m, 3) uint32.")
      .def_property_readonly("rest", &Deformation::surface, "The surface at rest.")
      .def_property_readonly("time", &Deformation::time, "Simulated time, s.")
      .def_property_readonly(
          "kinetic_energy", [](Deformation& d) { return d.simulation().kinetic_energy_J(); }, "J.")
      .def_property_readonly(
          "elastic_energy", [](Deformation& d) { return d.simulation().elastic_energy_J(); }, "J.")
      .def("write_vertices", &write_into, py::arg("out").noconvert(),
           "Writes the vertices into your own array, (n, 3), float32 or float64, in C order, mm.")
      .def("surface", &as_surface,
           "The present surface, to keep or to save(), with the attribute displacement (mm, from rest).");
}

}  // namespace

void bind_deformation(py::module_& module) {
  py::class_<StepReport>(module, "StepReport", "What happened in a step.")
      .def_readonly("iterations", &StepReport::iterations, "Passes of the solver.")
      .def_readonly("rejections", &StepReport::rejections,
                    "Updates rejected because they would have raised the energy.")
      .def_readonly("work", &StepReport::work_J, "Work done by forces, gravity and dragged nodes, J.")
      .def_readonly("movement", &StepReport::movement_mm,
                    "Largest movement in the last iteration, mm: a measure of convergence.")
      .def_readonly("awake", &StepReport::awake, "Nodes that are not at rest.");
  py::class_<HandForce>(module, "HandForce", "What pulls at a hand at the end of a step.")
      .def_property_readonly(
          "force", [](const HandForce& f) { return array_of(f.force_N); }, "(3,), N.")
      .def_property_readonly(
          "torque", [](const HandForce& f) { return array_of(f.torque_N_mm); },
          "(3,), N mm, of an instrument about its position.")
      .def_readonly("contacts", &HandForce::contacts,
                    "Pairs of an instrument's part and a segment that repel each other.")
      .def_readonly("behind", &HandForce::behind_mm, "How far it still is from where it should be, mm.")
      .def_readonly("holds", &HandForce::holds, "Of jaws: not lost.");
  const Material material;
  const SimulationOptions options;
  DeformationClass deformation(module, "Deformation",
                               R"(A centerline that moves under forces, and the surface that follows.

    surface           bound to a centerline, as generate() makes it
    young_Pa          Young's modulus
    density_kg_m3
    poisson_ratio     0 to 0.5
    wall_mm           thickness of the wall; 0: wall_ratio decides
    wall_ratio        the same in local radii, up to 1, which is solid
    damping_s         time in which a stretch relaxes
    step_s            of time
    iterations        of a step
    gravity_mm_s2     (3,)
    drag_per_s        velocities fade at this rate
    squeeze_response_s  in which a profile follows a squeeze
    rest_tolerance    what moves by less, in local radii, comes to rest; 0: nothing does

Use it from one thread at a time.)");
  deformation.def(py::init([](const SurfacePtr& surface, double young, double density, double poisson, double wall_mm,
                              double wall_ratio, double damping, double step_s, int iterations,
                              const py::object& gravity, double drag, double squeeze_response, double rest_tolerance) {
                    return std::make_shared<Deformation>(
                        surface, Material{young, density, poisson, wall_mm, wall_ratio, damping},
                        options_of(step_s, iterations, gravity, drag, squeeze_response, rest_tolerance));
                  }),
                  py::arg("surface").none(false), py::kw_only(), py::arg("young_Pa") = material.young_Pa,
                  py::arg("density_kg_m3") = material.density_kg_m3, py::arg("poisson_ratio") = material.poisson_ratio,
                  py::arg("wall_mm") = material.wall_mm, py::arg("wall_ratio") = material.wall_ratio,
                  py::arg("damping_s") = material.damping_s, py::arg("step_s") = options.step_s,
                  py::arg("iterations") = options.iterations, py::arg("gravity_mm_s2") = py::make_tuple(0.0, 0.0, 0.0),
                  py::arg("drag_per_s") = options.drag_per_s,
                  py::arg("squeeze_response_s") = options.squeeze_response_s,
                  py::arg("rest_tolerance") = options.rest_tolerance);
  deformation.def(
      "step", &step, py::arg("count") = 1, py::arg("then") = py::none(),
      "Advances by `count` steps, then updates the surface; with `then`, a function, it does so and calls it "
      "after every step. Returns the StepReport of the last step.");
  bind_actions(deformation);
  bind_hands(deformation);
  bind_state(deformation);
}

}  // namespace vmesh::python

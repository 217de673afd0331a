#include "verbs/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"

#include "report/json.h"
#include "verbs/scene_element.h"

namespace vmesh::tool {
namespace {

constexpr const char* kSchema = "vmesh.scene/1";
/// Limit on a scene's length, so that a mistyped digit gives an error instead of an overnight run.
constexpr double kMostSteps = 10e6;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

Course<double> number_course(const Element& element, double low) {
  return read_course<double>(element, [low](const Element& item) {
    const std::vector<double> v = item.numbers(2, "[time_s, value]");
    if (v[1] < low) item.fail("the value is too small");
    return std::pair(v[0], v[1]);
  });
}

Material read_material(const Element& element) {
  element.allow({"young_Pa", "density_kg_m3", "poisson_ratio", "wall_mm", "wall_ratio", "damping_s"});
  Material material;
  element.take("young_Pa", 1e-3, 1e13, material.young_Pa);
  element.take("density_kg_m3", 1e-3, 1e6, material.density_kg_m3);
  element.take("poisson_ratio", 0, 0.5, material.poisson_ratio);
  if (element.has("wall_mm") && element.has("wall_ratio"))
    element.member("wall_ratio").fail("the wall is already given as wall_mm; leave one of them out");
  element.take("wall_mm", 0, 1e6, material.wall_mm);
  element.take("wall_ratio", 1e-6, 1, material.wall_ratio);
  element.take("damping_s", 0, 1e6, material.damping_s);
  return material;
}

Integrator read_integrator(const Element& element) {
  const std::string name = element.text();
  if (name != "implicit" && name != "paper") element.fail("it is \"" + name + "\"; there are implicit and paper");
  return name == "paper" ? Integrator::paper : Integrator::implicit;
}

void read_options(const Element& root, Scene& scene) {
  SimulationOptions& options = scene.options;
  if (root.has("integrator")) options.integrator = read_integrator(root.member("integrator"));
  root.take("step_s", 1e-7, 10, options.step_s);
  root.take("iterations", 1, 1000, options.iterations);
  root.take("drag_per_s", 0, 1e9, options.drag_per_s);
  root.take("squeeze_response_s", 0, 1e6, options.squeeze_response_s);
  root.take("duration_s", 0, 1e6, scene.duration_s);
  root.take("frame_every", 1, 1e9, scene.frame_every);
  if (root.has("gravity_m_s2")) {
    const std::vector<double> g = root.member("gravity_m_s2").numbers(3, "[x, y, z]");
    options.gravity_mm_s2 = 1e3 * Vec3(g[0], g[1], g[2]);
  }
  if (scene.duration_s / options.step_s > kMostSteps)
    root.member("duration_s")
        .fail("that is more than ten million steps of step_s; lengthen the step or shorten the scene");
}

Scene::Drag read_drag(const Element& element, std::size_t nodes) {
  element.allow({"node", "path", "start_s", "release_s"});
  Scene::Drag drag{element.member("node").node(nodes), vector_course(element.member("path")), 0, kInfinite};
  element.take("start_s", 0, 1e6, drag.start_s);
  element.take("release_s", drag.start_s, 1e6, drag.release_s);
  return drag;
}

/// Checks the last drag against everything else that holds or drags its node.
void check_drag(const Element& element, const Scene& scene) {
  const Index node = scene.drags.back().node;
  const std::string name = "node " + std::to_string(node);
  const auto holds = [&](const std::vector<Index>& nodes) {
    return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
  };
  if (holds(scene.fix)) element.member("node").fail(name + " is fixed, too; leave out one of the two");
  for (auto earlier = scene.drags.begin(); earlier + 1 != scene.drags.end(); ++earlier)
    if (earlier->node == node && earlier->release_s > scene.drags.back().start_s)
      element.member("node").fail(name + " is dragged already; make one path of both, or start (start_s) after the " +
                                  "release (release_s) of the one before");
}

Scene::Place read_place(const Element& element, std::size_t nodes) {
  Scene::Place place{element.name()};
  if (element.has("node") + element.has("segment") + element.has("position_mm") != 1)
    element.fail("give one place: \"node\", \"segment\" with \"parameter\", or \"position_mm\"");
  if (element.has("parameter") != element.has("segment"))
    element.fail("\"parameter\", from 0 to 1 along the \"segment\", is given with it and only with it");
  if (element.has("node")) place.node = element.member("node").node(nodes);
  if (element.has("position_mm")) {
    const std::vector<double> p = element.member("position_mm").numbers(3, "[x, y, z]");
    place.position_mm = Vec3(p[0], p[1], p[2]);
  }
  if (!element.has("segment")) return place;
  const double segment = element.member("segment").number(0, kNone - 1.0);
  if (segment != std::floor(segment)) element.member("segment").fail("it must be an integer, the number of a segment");
  place.segment = static_cast<Index>(segment);
  element.take("parameter", 0, 1, place.t);
  return place;
}

void read_cuts(const Element& root, std::size_t nodes, Scene& scene) {
  for (const Element& item : root.items("cut")) {
    item.allow({"time_s", "node", "segment", "parameter", "position_mm"});
    scene.cuts.push_back({read_place(item, nodes), item.member("time_s").number(0, scene.duration_s)});
  }
  for (const Element& item : root.items("clip")) {
    item.allow({"time_s", "closing_s", "scale", "width_mm", "node", "segment", "parameter", "position_mm"});
    Scene::Clip clip{read_place(item, nodes), item.member("time_s").number(0, scene.duration_s)};
    item.take("closing_s", 1e-6, 1e6, clip.closing_s);
    item.take("scale", 1e-3, 1, clip.scale);
    item.take("width_mm", 1e-6, 1e6, clip.width_mm);
    scene.clips.push_back(clip);
  }
}

Scene read(const Element& root, std::size_t nodes, std::size_t segments) {
  root.allow(
      {"schema",       "material",    "integrator",   "step_s",      "iterations", "drag_per_s", "squeeze_response_s",
       "duration_s",   "frame_every", "gravity_m_s2", "fix",         "clamp",      "drag",       "force",
       "radial_scale", "squeeze",     "contact",      "instruments", "grasp",      "tissue",     "cut",
       "clip"});
  if (root.member("schema").text() != kSchema)
    root.member("schema").fail(std::string("this version reads \"") + kSchema + "\"");
  Scene scene;
  if (root.has("material")) scene.material = read_material(root.member("material"));
  read_options(root, scene);
  for (const Element& item : root.items("fix")) scene.fix.push_back(item.node(nodes));
  for (const Element& item : root.items("clamp")) scene.clamp.push_back(item.node(nodes));
  for (const Element& item : root.items("drag")) {
    scene.drags.push_back(read_drag(item, nodes));
    check_drag(item, scene);
  }
  for (const Element& item : root.items("force")) {
    item.allow({"node", "force_N"});
    scene.forces.push_back({item.member("node").node(nodes), vector_course(item.member("force_N"))});
  }
  for (const Element& item : root.items("radial_scale")) {
    item.allow({"node", "scale"});
    scene.scales.push_back({item.member("node").node(nodes), number_course(item.member("scale"), 1e-6)});
  }
  for (const Element& item : root.items("squeeze")) {
    item.allow({"node", "force_N"});
    scene.squeezes.push_back({item.member("node").node(nodes), number_course(item.member("force_N"), -1e12)});
  }
  read_cuts(root, nodes, scene);
  scene.touching = read_touching(root, segments);
  if (scene.touching.exists() && scene.options.integrator == Integrator::paper)
    root.fail("contact, instruments, grasp and tissue need the integrator \"implicit\"");
  return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& path, std::size_t nodes, std::size_t segments) {
  return parse_scene(read_file(path), path.string(), nodes, segments);
}

Scene parse_scene(const std::string& text, const std::string& source, std::size_t nodes, std::size_t segments) {
  Json document;
  try {
    document = Json::parse(text);
  } catch (const Json::exception& error) {
    throw InvalidInput(source + ": this is not valid JSON: " + error.what());
  }
  return read(Element(document, "", source), nodes, segments);
}

}  // namespace vmesh::tool

#include "verbs/live_scene.h"

#include <algorithm>
#include <string>
#include <vector>

#include "vmesh/core/error.h"

namespace vmesh::tool {
namespace {

/// What pages begin with where no scene says otherwise: a step for every frame of a usual screen, and the lowest node
/// of every component clamped, as vessels hang from something.
Scene scene_of_hands(const Centerline& centerline) {
  Scene scene;
  scene.options.step_s = 1.0 / 60;
  std::vector<char> seen(centerline.component_count());
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    char& has_one = seen[centerline.component_of_node()[n]];
    if (!has_one && centerline.degree(n) > 0) scene.clamp.push_back(n);
    has_one = 1;
  }
  return scene;
}

void check_tissue(const std::vector<SceneTouching::Tissue>& tissues, const std::string& name) {
  const auto is_somewhere = [](const SceneTouching::Tissue& t) { return t.sphere || t.segments || t.branches; };
  if (tissues.size() > 1 || std::any_of(tissues.begin(), tissues.end(), is_somewhere))
    throw InvalidInput(name + ": tissue: pages that move have one, everywhere; leave out sphere, segments and " +
                       "branches, and all but one, for --live");
}

bool leaves_to_hands(const Scene& scene) {
  return !scene.drags.empty() || !scene.forces.empty() || !scene.scales.empty() || !scene.squeezes.empty() ||
         !scene.touching.instruments.empty() || !scene.touching.grasps.empty() || !scene.cuts.empty();
}

}  // namespace

Scene live_scene(const std::filesystem::path& script, const Centerline& centerline, Console& console) {
  if (script.empty()) return scene_of_hands(centerline);
  Scene scene = read_scene(script, centerline.nodes().size(), centerline.segments().size());
  const std::string name = script.string();
  if (scene.options.integrator != Integrator::implicit)
    throw InvalidInput(name + ": integrator: pages that move have \"implicit\" only; leave \"paper\" out for --live");
  if (!scene.clips.empty()) throw InvalidInput(name + ": clip: pages that move have none; leave it out for --live");
  check_tissue(scene.touching.tissues, name);
  if (leaves_to_hands(scene))
    console.warn(name + ": the page leaves drag, force, radial_scale, squeeze, instruments, grasp and cut to your " +
                 "hands; it takes the rest");
  return scene;
}

}  // namespace vmesh::tool

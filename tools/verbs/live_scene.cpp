#include "verbs/live_scene.h"

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

}  // namespace

Scene live_scene(const std::filesystem::path& script, const Centerline& centerline, Console& console) {
  if (script.empty()) return scene_of_hands(centerline);
  Scene scene = read_scene(script, centerline.nodes().size(), centerline.segments().size());
  const std::string name = script.string();
  if (scene.options.integrator != Integrator::implicit)
    throw InvalidInput(name + ": integrator: pages that move have \"implicit\" only; leave \"paper\" out for --live");
  if (scene.touching.exists() || !scene.cuts.empty() || !scene.clips.empty())
    throw InvalidInput(name +
                       ": pages that move have no contact, instruments, grasp, tissue, cut and clip; leave them " +
                       "out for --live");
  if (!scene.drags.empty() || !scene.forces.empty() || !scene.scales.empty() || !scene.squeezes.empty())
    console.warn(name + ": the page leaves drag, force, radial_scale and squeeze to your hands; it takes the rest");
  return scene;
}

}  // namespace vmesh::tool

#include "verbs/stage.h"

#include <algorithm>
#include <sstream>

#include "vmesh/core/error.h"

namespace vmesh::tool {
namespace {

/// Segments stretched to more than this many times their length or radius, whichever is longer, are no longer vessels.
constexpr double kMostStretched = 100;

}  // namespace

Stage::Stage(const Centerline& centerline, const Scene& scene, bool notes_forces)
    : scene_(scene),
      simulation_(centerline, segment_properties(centerline, scene.material), scene.options),
      notes_forces_(notes_forces) {
  for (const Index node : scene.fix) simulation_.fix(node);
  for (const Index node : scene.clamp) simulation_.clamp(node);
  for (const Scene::Drag& drag : scene.drags) dragged_from_.push_back(simulation_.position(drag.node));
  if (scene.touching.exists()) touching_.emplace(scene.touching, centerline, simulation_);
}

void Stage::step(double time) {
  for (std::size_t i = 0; i < scene_.drags.size(); ++i) pull(scene_.drags[i], dragged_from_[i], time);
  for (const Scene::Force& force : scene_.forces) simulation_.set_force(force.node, force.force_N.at(time));
  for (const Scene::Profile& scale : scene_.scales) simulation_.set_radial_scale(scale.node, scale.value.at(time));
  for (const Scene::Profile& squeeze : scene_.squeezes) simulation_.set_squeeze(squeeze.node, squeeze.value.at(time));
  if (touching_) touching_->act(simulation_, time, [this](const SegmentPlace& place) { return now(place); });
  const StepReport report = simulation_.step();
  check_range(time);
  if (notes_forces_) note_forces(time);
  work_J_ += report.work_J;
  last_movement_mm_ = report.movement_mm;
}

void Stage::cut(const CenterlineCut& cut) {
  simulation_.cut(cut);
  since_.push_back([cut](const SegmentPlace& place) { return cut.after(place); });
}

void Stage::divide(const InsertedNode& node) {
  simulation_.divide(node);
  since_.push_back([node](const SegmentPlace& place) { return node.after(place); });
}

SegmentPlace Stage::now(SegmentPlace place) const {
  for (const auto& step : since_) place = step(place);
  return place;
}

void Stage::note_forces(double time) {
  for (const Scene::Drag& drag : scene_.drags)
    forces_.add(time, "node " + std::to_string(drag.node), simulation_.drag_force(drag.node));
  const SceneTouching& touching = scene_.touching;
  for (std::size_t i = 0; i < touching.grasps.size(); ++i)
    if (touching_->jaws()[i] != kNone)
      forces_.add(time, touching.grasps[i].name, simulation_.jaw_force(touching_->jaws()[i]));
  for (std::size_t i = 0; i < touching.instruments.size(); ++i)
    if (touching_->instruments()[i] != kNone)
      forces_.add(time, touching.instruments[i].name, simulation_.instrument_force(touching_->instruments()[i]));
}

void Stage::pull(const Scene::Drag& drag, const Vec3& from, double time) {
  const double step = scene_.options.step_s;
  if (time < drag.start_s) return;
  if (time <= drag.release_s)
    simulation_.drag(drag.node, from + drag.offset_mm.at(time));
  else if (time - step <= drag.release_s)
    simulation_.release(drag.node);
}

void Stage::check_range(double time) const {
  const RodTree& tree = simulation_.tree();
  const std::vector<Vec3>& position = simulation_.pose().position;
  for (Index j = 0; j < tree.size(); ++j) {
    const Index parent = tree.parent[j];
    const bool is_root = parent == kNone;
    const double stretch =
        is_root ? 0 : (position[j] - position[parent]).norm() / std::max(tree.length[j], tree.radius[j]);
    if (position[j].allFinite() && stretch <= kMostStretched) continue;
    std::ostringstream text;
    text << "the motion leaves its physical range at " << time << " s, at node " << tree.node[j] << ": ";
    if (position[j].allFinite()) {
      text << "segment " << tree.segment[j] << " is stretched to " << stretch << " times its length or radius";
    } else {
      text << "its position is not finite";
    }
    text << "; shorten step_s, or check the forces, the paths and the material";
    throw InvalidInput(text.str());
  }
}

}  // namespace vmesh::tool

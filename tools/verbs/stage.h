#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "vmesh/deform/simulation.h"

#include "verbs/scene.h"

namespace vmesh::tool {

/// Plays a scene on a simulation.
class Stage {
 public:
  /// `notes_forces`: of all hands, after every step. Keeps a reference to `scene`.
  Stage(const Centerline& centerline, const Scene& scene, bool notes_forces);

  /// The step that ends at `time`, s. Throws InvalidInput where the motion leaves its physical range.
  void step(double time);

  /// Numbers of the scene still are those of the centerline of before.
  void cut(const CenterlineCut& cut);
  void divide(const InsertedNode& node);

  CenterlineSimulation& simulation() { return simulation_; }
  double work_J() const { return work_J_; }
  double last_movement_mm() const { return last_movement_mm_; }
  const HandForces& forces() const { return forces_; }

 private:
  SegmentPlace now(SegmentPlace place) const;
  void note_forces(double time);
  void pull(const Scene::Drag& drag, const Vec3& from, double time);
  void check_range(double time) const;

  const Scene& scene_;
  CenterlineSimulation simulation_;
  bool notes_forces_;
  std::vector<Vec3> dragged_from_;
  std::vector<std::function<SegmentPlace(const SegmentPlace&)>> since_;  // cuts and divisions
  std::optional<TouchingStage> touching_;
  HandForces forces_;
  double work_J_ = 0, last_movement_mm_ = 0;
};

}  // namespace vmesh::tool

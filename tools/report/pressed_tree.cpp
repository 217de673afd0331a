#include "report/pressed_tree.h"

#include <algorithm>
#include <cmath>

#include "vmesh/core/error.h"

namespace vmesh::tool {
namespace {

constexpr std::size_t kBalls = 30, kPlaces = 90;  // where another vessel is, there is no ball

CenterlineSimulation never_at_rest(const Centerline& centerline) {
  SimulationOptions options;
  options.rest_tolerance = 0;
  return {centerline, segment_properties(centerline, {.damping_s = 0.05}), options};
}

}  // namespace

PressedTree::PressedTree(const Centerline& centerline) : simulation_(never_at_rest(centerline)) {
  simulation_.clamp(0);
  for (std::size_t k = 1; from_.size() < kBalls && k < kPlaces; ++k) {
    const Index s = static_cast<Index>(k * centerline.segments().size() / kPlaces);
    const Vec3 along = (centerline.point_at(s, 1) - centerline.point_at(s, 0)).normalized();
    const Vec3 side = along.unitOrthogonal();
    const double radius = centerline.radius_at(s, 0.5);
    InstrumentPose pose;
    pose.position_mm = centerline.point_at(s, 0.5) + 1.6 * radius * side;
    try {
      simulation_.add_instrument({{Vec3::Zero()}, {0.5 * radius}, 0.2}, pose);
    } catch (const InvalidInput&) {
      continue;
    }
    from_.push_back(pose.position_mm);
    towards_.push_back(-radius * side);
  }
}

StepReport PressedTree::step() {
  time_ += 0.02;
  for (std::size_t k = 0; k < from_.size(); ++k) {
    InstrumentPose pose;
    pose.position_mm = from_[k] + (0.6 + 0.2 * std::sin(time_)) * std::min(1.0, time_) * towards_[k];
    simulation_.move_instrument(static_cast<Index>(k), pose);
  }
  return simulation_.step();
}

int PressedTree::contacts() const {
  int contacts = 0;
  for (std::size_t k = 0; k < from_.size(); ++k)
    contacts += simulation_.instrument_force(static_cast<Index>(k)).contacts;
  return contacts;
}

}  // namespace vmesh::tool

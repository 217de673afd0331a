#pragma once

#include <limits>
#include <string>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// How things that touch act on each other. Two things repel each other before they touch: from a gap of `gap_ratio`
/// times the smallest radius of the two, ever more the narrower it is (incremental potential contact: Li et al. 2020).
struct ContactOptions {
  bool self = false;        ///< vessels touch vessels; otherwise they pass through each other
  double gap_ratio = 0.05;  ///< in (0, 1]
  double friction = 0;      ///< coefficient between vessels, in [0, 10]
  /// Gauss-Newton iterations per step at most while something touches, beyond those of the simulation.
  int iterations = 12;
  /// Speed below which friction yields instead of slipping, in radii of the vessel per second; > 0.
  double slip_radii_per_s = 0.01;
};

/// A chain of round cones, rigid: points in a frame of its own with a radius at each. One point: a ball.
struct InstrumentShape {
  std::vector<Vec3> points_mm;
  std::vector<double> radii_mm;  ///< > 0
  double friction = 0;           ///< coefficient, in [0, 10]
};

/// Where an instrument's frame is: x = rotation * own + position.
struct InstrumentPose {
  Vec3 position_mm = Vec3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// The pose between two: positions along a line, rotations about one axis, the short way.
InstrumentPose between(const InstrumentPose& a, const InstrumentPose& b, double part);

/// Poses over time: between() keys, constant before the first and after the last.
struct InstrumentPath {
  std::vector<double> time_s;  ///< ascending, at least one
  std::vector<InstrumentPose> pose;

  InstrumentPose at(double time) const;
};

/// What a vessel tree exerts on a hand that holds something, at the end of a step.
struct HandForce {
  Vec3 force_N = Vec3::Zero();
  Vec3 torque_N_mm = Vec3::Zero();  ///< of an instrument: about its position
  int contacts = 0;                 ///< pairs of an instrument's part and a segment that repel each other
  double behind_mm = 0;             ///< how far it still is from where it should be: something is in the way
  bool holds = true;                ///< jaws: not lost
};

/// Springs between a vessel and where it rests, as of the fat around it.
struct TissueProperties {
  double stiffness_N_mm2 = 0;                                  ///< N per mm of displacement and mm of vessel; >= 0
  double tear_N_mm = std::numeric_limits<double>::infinity();  ///< tears above this force per mm of vessel; > 0
};

}  // namespace vmesh

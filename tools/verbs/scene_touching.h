#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "vmesh/deform/simulation.h"

#include "report/json.h"
#include "verbs/course.h"

namespace vmesh::tool {

class Element;

/// What vessels touch in a scene.
struct SceneTouching {
  struct Instrument {
    std::string name;
    InstrumentShape shape;
    InstrumentPath path;
    double enter_s = 0, leave_s = std::numeric_limits<double>::infinity();
  };
  struct Grasp {
    std::string name;
    Index segment;
    double t;
    double slips_N;
    double close_s, release_s;
    Course<Vec3> offset_mm;  ///< from where the jaws close
  };
  struct Sphere {
    Vec3 center_mm;
    double radius_mm;
  };
  /// Everywhere, or on what is listed.
  struct Tissue {
    TissueProperties properties;
    std::optional<Sphere> sphere;
    std::optional<std::vector<Index>> segments, branches;
  };

  std::optional<ContactOptions> contact;
  std::vector<Instrument> instruments;
  std::vector<Grasp> grasps;
  std::vector<Tissue> tissues;

  bool exists() const { return contact || !instruments.empty() || !grasps.empty() || !tissues.empty(); }
};

/// Its errors name the element.
SceneTouching read_touching(const Element& root, std::size_t segments);

/// Plays it on a simulation, whose nodes are at rest at first.
class TouchingStage {
 public:
  /// Throws InvalidInput naming the instrument that starts in a vessel, and the branch that does not exist.
  TouchingStage(const SceneTouching& scene, const Centerline& centerline, CenterlineSimulation& simulation);

  /// To be called before each step. `now`: where a place of the scene's centerline is on the one that moves.
  void act(CenterlineSimulation& simulation, double time_s,
           const std::function<SegmentPlace(const SegmentPlace&)>& now);

  const std::vector<Index>& jaws() const { return jaws_; }  ///< kNone: not closed yet
  /// kNone: has not entered yet, or has left.
  const std::vector<Index>& instruments() const { return instruments_; }

 private:
  void enter(std::size_t i, CenterlineSimulation& simulation, double time_s);
  void guide(std::size_t i, CenterlineSimulation& simulation, double time_s);

  const SceneTouching& scene_;
  std::vector<Index> instruments_;
  std::vector<char> left_;
  std::vector<Index> jaws_;
  std::vector<Vec3> closed_at_;
  std::vector<char> open_;
};

/// The forces on all hands after every step, as a table, and their largest.
class HandForces {
 public:
  void add(double time_s, const std::string& hand, const HandForce& force);

  std::string csv() const;
  Json to_json() const;

 private:
  struct Row {
    double time_s;
    std::size_t hand;
    HandForce force;
  };
  std::vector<std::string> hands_;
  std::vector<Row> rows_;
};

}  // namespace vmesh::tool

#include "verbs/scene_touching.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/text.h"

#include "verbs/scene_element.h"

namespace vmesh::tool {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

Index integer(const Element& element, std::size_t count, const char* what) {
  if (count == 0) element.fail("the centerline has none");
  const double value = element.number(0, static_cast<double>(count) - 1);
  if (value != std::floor(value)) element.fail(std::string("it must be an integer, the number of a ") + what);
  return static_cast<Index>(value);
}

std::vector<Index> integers(const Element& element, std::size_t count, const char* what) {
  std::vector<Index> numbers;
  for (const Element& item : element.items()) numbers.push_back(integer(item, count, what));
  return numbers;
}

Vec3 vector3(const Element& element) {
  const std::vector<double> v = element.numbers(3, "[x, y, z]");
  return {v[0], v[1], v[2]};
}

ContactOptions read_contact(const Element& element) {
  element.allow({"self", "gap_ratio", "friction", "iterations", "slip_radii_per_s"});
  ContactOptions options;
  if (element.has("self")) options.self = element.member("self").boolean();
  element.take("gap_ratio", 1e-6, 1, options.gap_ratio);
  element.take("friction", 0, 10, options.friction);
  element.take("iterations", 1, 1000, options.iterations);
  element.take("slip_radii_per_s", 1e-9, 1e9, options.slip_radii_per_s);
  return options;
}

/// One radius for all points, or one each.
std::vector<double> read_radii(const Element& element, std::size_t points) {
  if (!element.is_array()) return std::vector<double>(points, element.number(1e-9, 1e9));
  std::vector<double> radii;
  for (const Element& item : element.items()) radii.push_back(item.number(1e-9, 1e9));
  if (radii.size() != points)
    element.fail("there are " + std::to_string(points) + " points and " + std::to_string(radii.size()) +
                 " radii; give one each, or a number for all");
  return radii;
}

InstrumentPath read_path(const Element& element) {
  InstrumentPath path;
  for (const Element& item : element.items()) {
    const bool turns = item.items().size() == 8;
    const std::vector<double> v = item.numbers(turns ? 8 : 4, "[time_s, x, y, z] or [time_s, x, y, z, qw, qx, qy, qz]");
    InstrumentPose pose;
    pose.position_mm = Vec3(v[1], v[2], v[3]);
    if (turns) pose.rotation = Eigen::Quaterniond(v[4], v[5], v[6], v[7]);
    if (!(std::abs(pose.rotation.norm() - 1) < 1e-3)) item.fail("its rotation must be a quaternion of length 1");
    pose.rotation.normalize();
    if (!path.time_s.empty() && v[0] <= path.time_s.back()) item.fail("times must ascend");
    path.time_s.push_back(v[0]);
    path.pose.push_back(pose);
  }
  if (path.time_s.empty()) element.fail("it must have at least one point");
  return path;
}

SceneTouching::Instrument read_instrument(const Element& element, std::size_t number) {
  element.allow({"name", "points_mm", "radius_mm", "friction", "path", "enter_s", "leave_s"});
  SceneTouching::Instrument instrument;
  instrument.name = element.has("name") ? element.member("name").text() : "instrument " + std::to_string(number);
  for (const Element& point : element.member("points_mm").items()) instrument.shape.points_mm.push_back(vector3(point));
  if (instrument.shape.points_mm.empty()) element.member("points_mm").fail("it must have at least one point");
  instrument.shape.radii_mm = read_radii(element.member("radius_mm"), instrument.shape.points_mm.size());
  element.take("friction", 0, 10, instrument.shape.friction);
  instrument.path = read_path(element.member("path"));
  element.take("enter_s", 0, 1e6, instrument.enter_s);
  element.take("leave_s", 0, 1e6, instrument.leave_s);
  if (instrument.leave_s <= instrument.enter_s) element.member("leave_s").fail("it must enter (enter_s) before");
  return instrument;
}

SceneTouching::Grasp read_grasp(const Element& element, std::size_t number, std::size_t segments) {
  element.allow({"name", "segment", "parameter", "slips_N", "close_s", "release_s", "path"});
  SceneTouching::Grasp grasp{"grasp " + std::to_string(number),
                             integer(element.member("segment"), segments, "segment of the centerline"),
                             0.5,
                             kNever,
                             0,
                             kNever,
                             vector_course(element.member("path"))};
  if (element.has("name")) grasp.name = element.member("name").text();
  element.take("parameter", 0, 1, grasp.t);
  element.take("slips_N", 1e-12, 1e12, grasp.slips_N);
  element.take("close_s", 0, 1e6, grasp.close_s);
  element.take("release_s", 0, 1e6, grasp.release_s);
  if (grasp.release_s <= grasp.close_s) element.member("release_s").fail("the jaws must close (close_s) before");
  return grasp;
}

SceneTouching::Tissue read_tissue(const Element& element, std::size_t segments) {
  element.allow({"stiffness_N_mm2", "tear_N_mm", "sphere", "segments", "branches"});
  SceneTouching::Tissue tissue;
  tissue.properties.stiffness_N_mm2 = element.member("stiffness_N_mm2").number(0, 1e12);
  element.take("tear_N_mm", 1e-12, 1e12, tissue.properties.tear_N_mm);
  if (element.has("sphere")) {
    const Element sphere = element.member("sphere");
    sphere.allow({"center_mm", "radius_mm"});
    tissue.sphere = {vector3(sphere.member("center_mm")), sphere.member("radius_mm").number(1e-9, 1e9)};
  }
  if (element.has("segments"))
    tissue.segments = integers(element.member("segments"), segments, "segment of the centerline");
  if (element.has("branches")) tissue.branches = integers(element.member("branches"), segments, "branch");
  if ((tissue.sphere ? 1 : 0) + (tissue.segments ? 1 : 0) + (tissue.branches ? 1 : 0) > 1)
    element.fail("give one of sphere, segments and branches, or none of them for everywhere");
  return tissue;
}

std::vector<Index> segments_of(const SceneTouching::Tissue& tissue, const Centerline& centerline, std::size_t number) {
  if (tissue.segments) return *tissue.segments;
  std::vector<Index> chosen;
  if (tissue.branches) {
    const std::vector<Branch> branches = find_branches(centerline);
    for (const Index b : *tissue.branches) {
      if (b >= branches.size())
        throw InvalidInput("tissue[" + std::to_string(number) + "].branches: there is no branch " + std::to_string(b) +
                           "; the centerline has " + std::to_string(branches.size()) + ", counted from 0");
      chosen.insert(chosen.end(), branches[b].segments.begin(), branches[b].segments.end());
    }
    return chosen;
  }
  for (Index s = 0; s < centerline.segments().size(); ++s)
    if (!tissue.sphere || (centerline.point_at(s, 0.5) - tissue.sphere->center_mm).norm() <= tissue.sphere->radius_mm)
      chosen.push_back(s);
  return chosen;
}

/// With quotes where a comma, quote or line break would end the cell.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

SceneTouching read_touching(const Element& root, std::size_t segments) {
  SceneTouching scene;
  if (root.has("contact")) scene.contact = read_contact(root.member("contact"));
  std::vector<std::string> names;
  const auto name = [&](const Element& item, const std::string& given) {
    if (std::find(names.begin(), names.end(), given) != names.end())
      item.fail("\"" + given + "\" is the name of another one already; give each its own");
    names.push_back(given);
  };
  for (const Element& item : root.items("instruments")) {
    scene.instruments.push_back(read_instrument(item, scene.instruments.size()));
    name(item, scene.instruments.back().name);
  }
  for (const Element& item : root.items("grasp")) {
    scene.grasps.push_back(read_grasp(item, scene.grasps.size(), segments));
    name(item, scene.grasps.back().name);
  }
  for (const Element& item : root.items("tissue")) scene.tissues.push_back(read_tissue(item, segments));
  return scene;
}

TouchingStage::TouchingStage(const SceneTouching& scene, const Centerline& centerline, CenterlineSimulation& simulation)
    : scene_(scene),
      instruments_(scene.instruments.size(), kNone),
      left_(scene.instruments.size(), 0),
      jaws_(scene.grasps.size(), kNone),
      closed_at_(jaws_.size()),
      open_(jaws_.size(), 0) {
  if (scene.contact) simulation.set_contact(*scene.contact);
  for (std::size_t i = 0; i < scene.instruments.size(); ++i)
    if (scene.instruments[i].enter_s == 0) enter(i, simulation, 0);
  for (std::size_t i = 0; i < scene.tissues.size(); ++i)
    for (const Index s : segments_of(scene.tissues[i], centerline, i))
      simulation.set_tissue(s, scene.tissues[i].properties);
}

void TouchingStage::enter(std::size_t i, CenterlineSimulation& simulation, double time_s) {
  const SceneTouching::Instrument& instrument = scene_.instruments[i];
  try {
    instruments_[i] = simulation.add_instrument(instrument.shape, instrument.path.at(time_s));
  } catch (const InvalidInput& error) {
    throw InvalidInput("instruments[" + std::to_string(i) + "] (" + instrument.name + "): " + error.what());
  }
}

void TouchingStage::guide(std::size_t i, CenterlineSimulation& simulation, double time_s) {
  const SceneTouching::Instrument& instrument = scene_.instruments[i];
  if (left_[i] || time_s < instrument.enter_s) return;
  if (time_s > instrument.leave_s) {
    if (instruments_[i] != kNone) simulation.remove_instrument(instruments_[i]);
    instruments_[i] = kNone;
    left_[i] = 1;
    return;
  }
  if (instruments_[i] == kNone) enter(i, simulation, instrument.enter_s);
  simulation.move_instrument(instruments_[i], instrument.path.at(time_s));
}

void TouchingStage::act(CenterlineSimulation& simulation, double time_s,
                        const std::function<SegmentPlace(const SegmentPlace&)>& now) {
  for (std::size_t i = 0; i < scene_.instruments.size(); ++i) guide(i, simulation, time_s);
  for (std::size_t i = 0; i < scene_.grasps.size(); ++i) {
    const SceneTouching::Grasp& grasp = scene_.grasps[i];
    if (open_[i] || time_s < grasp.close_s) continue;
    if (jaws_[i] == kNone) {
      const SegmentPlace place = now({grasp.segment, grasp.t});
      jaws_[i] = simulation.grasp(place.segment, place.t, grasp.slips_N);
      closed_at_[i] = simulation.jaw_position(jaws_[i]);
    }
    if (time_s > grasp.release_s) {
      simulation.open_jaw(jaws_[i]);
      open_[i] = 1;
    } else {
      simulation.move_jaw(jaws_[i], closed_at_[i] + grasp.offset_mm.at(time_s));
    }
  }
}

void HandForces::add(double time_s, const std::string& hand, const HandForce& force) {
  auto found = std::find(hands_.begin(), hands_.end(), hand);
  if (found == hands_.end()) found = hands_.insert(found, hand);
  rows_.push_back({time_s, static_cast<std::size_t>(found - hands_.begin()), force});
}

std::string HandForces::csv() const {
  std::string text =
      "time_s,hand,force_x_N,force_y_N,force_z_N,torque_x_N_mm,torque_y_N_mm,torque_z_N_mm,contacts,behind_mm,holds\n";
  for (const Row& row : rows_) {
    const Vec3 &f = row.force.force_N, &t = row.force.torque_N_mm;
    text += formatted("%.9g,", row.time_s) + cell(hands_[row.hand]) +
            formatted(",%.9g,%.9g,%.9g,", f.x(), f.y(), f.z()) + formatted("%.9g,%.9g,%.9g,", t.x(), t.y(), t.z()) +
            formatted("%d,%.9g,%d\n", row.force.contacts, row.force.behind_mm, row.force.holds ? 1 : 0);
  }
  return text;
}

Json HandForces::to_json() const {
  Json hands = Json::array();
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    const Row *last = nullptr, *strongest = nullptr;
    int contacts = 0;
    double behind_mm = 0;
    for (const Row& row : rows_) {
      if (row.hand != h) continue;
      last = &row;
      if (strongest == nullptr || row.force.force_N.norm() > strongest->force.force_N.norm()) strongest = &row;
      contacts = std::max(contacts, row.force.contacts);
      behind_mm = std::max(behind_mm, row.force.behind_mm);
    }
    hands.push_back({{"hand", hands_[h]},
                     {"largest_force_N", strongest->force.force_N.norm()},
                     {"largest_force_at_s", strongest->time_s},
                     {"largest_contacts", contacts},
                     {"largest_behind_mm", behind_mm},
                     {"last_force_N", tool::to_json(last->force.force_N)},
                     {"last_torque_N_mm", tool::to_json(last->force.torque_N_mm)},
                     {"holds", last->force.holds}});
  }
  return hands;
}

}  // namespace vmesh::tool

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vmesh/deform/simulation.h"

#include "verbs/course.h"
#include "verbs/scene_touching.h"

namespace vmesh::tool {

/// The contents of a scene file, which tools/README.md describes: what happens to a vessel tree.
struct Scene {
  struct Drag {
    Index node;
    Course<Vec3> offset_mm;  ///< from the node's position at rest
    double start_s = 0;      ///< not before
    double release_s;        ///< infinite: never
  };
  struct Force {
    Index node;
    Course<Vec3> force_N;
  };
  /// The scale of a node's profile, or the force on it, over time.
  struct Profile {
    Index node;
    Course<double> value;
  };

  /// Of these, one: a node, a segment and a place along it, or the nearest place to a position at rest (mm).
  struct Place {
    std::string element;  ///< for messages: "cut[0]"
    Index node = kNone, segment = kNone;
    double t = 0;
    std::optional<Vec3> position_mm = {};
  };
  struct Cut {
    Place place;
    double time_s;
  };
  /// Narrows the profile to `scale` between `time_s` and `closing_s` later.
  struct Clip {
    Place place;
    double time_s;
    double closing_s = 0.2, scale = 0.05;
    double width_mm = 0;  ///< 0: the radius
  };

  Material material;
  SimulationOptions options;
  double duration_s = 1;
  int frame_every = 1;  ///< steps from frame to frame
  std::vector<Index> fix, clamp;
  std::vector<Drag> drags;
  std::vector<Force> forces;
  std::vector<Profile> scales, squeezes;
  std::vector<Cut> cuts;
  std::vector<Clip> clips;
  SceneTouching touching;
};

/// Throws ReadError, and InvalidInput naming the file, the element, what is wrong and what to do. Node numbers must be
/// below `nodes`, those of segments below
/// `segments`.
Scene read_scene(const std::filesystem::path& path, std::size_t nodes, std::size_t segments);

/// The same from text; `source` names it in messages.
Scene parse_scene(const std::string& text, const std::string& source, std::size_t nodes, std::size_t segments);

}  // namespace vmesh::tool

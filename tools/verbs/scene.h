#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vmesh/deform/simulation.h"

namespace vmesh::tool {

/// A quantity over time: linear between its points, constant before the first and after the last.
template <class Value>
struct Course {
  std::vector<double> time_s;  ///< ascending, at least one
  std::vector<Value> value;

  Value at(double time) const {
    std::size_t next = 0;
    while (next < time_s.size() && time_s[next] <= time) ++next;
    if (next == 0) return value.front();
    if (next == time_s.size()) return value.back();
    const double part = (time - time_s[next - 1]) / (time_s[next] - time_s[next - 1]);
    return value[next - 1] + part * (value[next] - value[next - 1]);
  }
};

/// The contents of a scene file, which tools/README.md describes: what happens to a vessel tree.
struct Scene {
  struct Drag {
    Index node;
    Course<Vec3> offset_mm;  ///< from the node's position at rest
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

  Material material;
  SimulationOptions options;
  double duration_s = 1;
  int frame_every = 1;  ///< steps from frame to frame
  std::vector<Index> fix, clamp;
  std::vector<Drag> drags;
  std::vector<Force> forces;
  std::vector<Profile> scales, squeezes;
};

/// Throws ReadError, and InvalidInput naming the file, the element, what is wrong and what to do. Node numbers must be
/// below `nodes`.
Scene read_scene(const std::filesystem::path& path, std::size_t nodes);

/// The same from text; `source` names it in messages.
Scene parse_scene(const std::string& text, const std::string& source, std::size_t nodes);

}  // namespace vmesh::tool

#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "vmesh/core/progress.h"
#include "vmesh/parts/part_files.h"

namespace vmesh {

/// Receives a joined surface block by block: all vertices, then all faces.
class SurfaceSink {
 public:
  struct Vertices {
    std::span<const Vec3> position, normal;
    std::span<const double> radius;
    std::span<const SimplifiedCenterline::Place> place;  ///< in the centerline that was read
    std::span<const Index> branch;
  };
  struct Faces {
    std::span<const Triangle> corners;
    std::span<const double> skewness;  ///< equiangle
    std::span<const Index> branch;
  };

  virtual ~SurfaceSink() = default;
  virtual void begin(std::size_t vertices, std::size_t faces) = 0;
  virtual void add(const Vertices& vertices) = 0;
  virtual void add(const Faces& faces) = 0;
};

/// A defect that keeps parts from making a sound surface.
struct JoinDefect {
  DefectKind kind;
  Vec3 position = Vec3::Zero();  ///< mm
  std::string message;
};

struct JoinSummary {
  PartsManifest manifest;
  std::size_t vertices = 0, faces = 0;
  GrowthSummary growth;
  double mean_skewness = 0, max_skewness = 0;  ///< equiangle
  std::int64_t euler_characteristic = 0;
  std::size_t walls_parted = 0;     ///< pairs of faces of different pieces that crossed each other
  std::vector<JoinDefect> defects;  ///< none: the surface is sound, and went to the sink

  bool is_sound() const { return defects.empty(); }
};

/// Joins the surfaces of all parts in a folder that vmesh split wrote: vertices and faces as generate_surface() gives
/// them, to the bit. One part at a time is in memory, together with what meets at seams. Walls of different pieces that
/// cross each other are parted in place, for which the parts around are read again. Throws ReadError and InvalidInput
/// for parts that are missing or do not belong together, Cancelled.
JoinSummary join_parts(const std::filesystem::path& folder, SurfaceSink& sink, int threads,
                       const Progress& progress = {});

}  // namespace vmesh

#pragma once

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "vmesh/deform/surface_binding.h"

#include "command_line/arguments.h"
#include "verbs/cut_plan.h"
#include "verbs/stage.h"

namespace vmesh::tool {

/// Writes the moved input surface with the displacements of its vertices.
class FrameWriter {
 public:
  /// Keeps a reference to `writing`.
  FrameWriter(SurfaceMetadata metadata, const WritingArguments& writing)
      : writing_(writing), metadata_(std::move(metadata)) {}

  /// The surface that moves from now on, at rest; it is to outlive this.
  void begin(const BoundTree& rest);
  void write(const std::filesystem::path& path, const DeformedSurface& surface,
             const std::vector<Index>& lane_of_vertex);

  double largest_displacement_mm() const { return largest_mm_; }
  /// The mesh of the last frame written.
  const TriMesh& mesh() const { return mesh_; }
  const MeshAttributes& attributes() const { return attributes_; }

 private:
  const TriMesh* rest_ = nullptr;
  const WritingArguments& writing_;
  TriMesh mesh_;
  MeshAttributes attributes_;
  SurfaceMetadata metadata_;
  double largest_mm_ = 0;
};

/// The surface that moves with a stage, cut when it is time.
class MovingSurface {
 public:
  MovingSurface(const CutPlan& plan, Stage& stage, FrameWriter& writer) : plan_(plan), stage_(stage), writer_(writer) {
    begin();
  }

  /// Makes the cuts that are due; the surface stays where it is.
  void cut_until(double time_s);
  void follow() { binding_->apply(stage_.simulation().pose(), stage_.simulation().moved(), lanes_); }
  void write(const std::filesystem::path& path) { writer_.write(path, lanes_, binding_->lane_of_vertex()); }

  /// The last of all stages where it is now, before it was cut.
  std::vector<Vec3> last_vertices();
  std::vector<Vec3> last_nodes() const;

 private:
  void begin();

  const CutPlan& plan_;
  Stage& stage_;
  FrameWriter& writer_;
  std::size_t cuts_ = 0;
  std::optional<SurfaceBinding> binding_, last_;
  DeformedSurface lanes_;
};

}  // namespace vmesh::tool

#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "vmesh/io/surface_io.h"

namespace vmesh {

class AtomicFile;

/// Writes a PLY file block by block, as write_surface() would write the whole, in mm and LPS: for surfaces larger than
/// memory. All vertices come before the faces. The file appears when it is committed.
class PlyStream {
 public:
  /// `declared`: names and kinds of the attributes; values are ignored. Throws WriteError, and InvalidInput for more
  /// vertices or faces than the format can number.
  PlyStream(const std::filesystem::path& path, std::size_t vertices, std::size_t faces, const MeshAttributes& declared,
            const SurfaceMetadata& metadata);
  ~PlyStream();
  PlyStream(const PlyStream&) = delete;
  PlyStream& operator=(const PlyStream&) = delete;

  /// Writes the next vertices, mm. `attributes`: those declared, with a value per vertex each. Throws InvalidInput when
  /// they differ from what was declared.
  void add_vertices(std::span<const Vec3> positions, std::span<const Vec3> normals,
                    const std::vector<MeshAttribute>& attributes);
  void add_faces(std::span<const Triangle> faces, const std::vector<MeshAttribute>& attributes);
  /// Throws WriteError, and InvalidInput when something is missing.
  void commit();

 private:
  std::string name_;
  std::size_t vertex_attributes_, face_attributes_;
  std::size_t vertices_left_, faces_left_;
  std::unique_ptr<AtomicFile> file_;
  std::string bytes_;
};

}  // namespace vmesh

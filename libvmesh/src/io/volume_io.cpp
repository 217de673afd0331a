#include "vmesh/io/volume_io.h"

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"
#include "vmesh/mesh/volume_faces.h"

#include "lengths.h"

namespace vmesh {
namespace {

void check_attributes(const std::vector<MeshAttribute>& list, std::size_t count, const char* kind) {
  for (const MeshAttribute& a : list) {
    if (a.name.empty()) throw InvalidInput(std::string("a ") + kind + " attribute has no name");
    if (a.values.size() != count)
      throw InvalidInput(std::string("the ") + kind + " attribute " + a.name + " has " +
                         std::to_string(a.values.size()) + " values, there should be " + std::to_string(count));
  }
}

void check_writable(const VolumeMesh& mesh, const VolumeAttributes& attributes) {
  if (mesh.points.size() >= 0x80000000 || mesh.cell_count() + mesh.boundary.size() >= 0x80000000)
    throw InvalidInput("the volume mesh has too many points or cells for its file format (2^31)");
  check_volume_mesh(mesh);
  check_attributes(attributes.point, mesh.points.size(), "point");
  check_attributes(attributes.cell, mesh.cell_count(), "cell");
}

}  // namespace

const VolumeFormat* find_volume_format(const std::filesystem::path& path) {
  return find_format(volume_formats(), path);
}

const VolumeFormat& volume_output_format(const std::filesystem::path& path) {
  const VolumeFormat* format = find_volume_format(path);
  if (format != nullptr && format->is_written()) return *format;
  throw Unsupported(path.string() + ": \"" + extension_of(path) + "\" is not supported; write the volume mesh as " +
                    listed(extensions_of(volume_formats(), [](const auto& f) { return f.is_written(); })));
}

void write_volume(const std::filesystem::path& path, const VolumeMesh& mesh, const VolumeMetadata& metadata,
                  const VolumeAttributes& attributes, const VolumeWriteOptions& options) {
  const VolumeFormat& format = volume_output_format(path);
  try {
    check_writable(mesh, attributes);
    AtomicFile file(path);
    if (metadata.unit == LengthUnit::mm && metadata.space == Space::lps) {
      format.write(file.stream(), mesh, attributes, metadata, options);
    } else {
      VolumeMesh moved = mesh;
      VolumeAttributes scaled = attributes;
      const double scale = 1 / millimetres_per(metadata.unit);
      io::move_points(moved.points, scale, metadata.space);
      io::scale_lengths(scaled.point, scale);
      io::scale_lengths(scaled.cell, scale);
      format.write(file.stream(), moved, scaled, metadata, options);
    }
    file.commit();
  } catch (const InvalidInput& error) {
    throw InvalidInput(path.string() + ": " + error.what());
  }
}

}  // namespace vmesh

#include "vmesh/io/volume_io.h"

#include <list>
#include <memory>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/atomic_folder.h"
#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"
#include "vmesh/mesh/split_cells.h"
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

void check_cells(const std::filesystem::path& path, const VolumeFormat& format, const VolumeMesh& mesh) {
  const auto refuse = [&](const char* kind, std::size_t count) {
    throw Unsupported(path.string() + ": " + format.name + " holds no " + kind + ", and " + std::to_string(count) +
                      " cells of this mesh are such; have cells split into tetrahedra");
  };
  if (!format.holds_wedges && !mesh.wedges.empty()) refuse("wedges", mesh.wedges.size());
  if (!format.holds_pyramids && !mesh.pyramids.empty()) refuse("pyramids", mesh.pyramids.size());
}

template <class Wanted>
std::string listed_volume_files(Wanted wanted) {
  std::vector<std::string> words = extensions_of(volume_formats(), wanted);
  for (const VolumeFormat& format : volume_formats()) {
    if (format.is_folder() && wanted(format)) words.push_back("a folder whose name ends in " + format.folder);
  }
  return listed(words);
}

/// The files of a mesh that lie side by side and appear together.
class FilesSideBySide {
 public:
  FilesSideBySide(const std::filesystem::path& path, const VolumeFormat& format)
      : path_(path), stem_(path.string()), extension_(longest_extension(path, format.extensions)) {
    stem_.resize(stem_.size() - extension_.size());
  }

  std::ostream& open(const std::string& extension) {
    const bool is_given = extension.empty() || extension == extension_;  // which may be in upper case
    return files_.emplace_back(is_given ? path_ : std::filesystem::path(stem_ + extension)).stream();
  }

  void commit() {
    for (AtomicFile& file : files_) file.commit();
  }

 private:
  std::filesystem::path path_;
  std::string stem_, extension_;
  std::list<AtomicFile> files_;
};

void write_files(const std::filesystem::path& path, const VolumeFormat& format, const VolumeMesh& mesh,
                 const VolumeAttributes& attributes, const VolumeMetadata& metadata) {
  const auto write_to = [&](auto&& output) {
    format.write([&](const std::string& name) -> std::ostream& { return output.open(name); }, mesh, attributes,
                 metadata);
    output.commit();
  };
  if (format.is_folder()) {
    write_to(AtomicFolder(path, format.is_file));
  } else {
    write_to(FilesSideBySide(path, format));
  }
}

void write_converted(const std::filesystem::path& path, const VolumeFormat& format, const VolumeMesh& mesh,
                     const VolumeAttributes& attributes, const VolumeMetadata& metadata) {
  if (metadata.unit == LengthUnit::mm && metadata.space == Space::lps)
    return write_files(path, format, mesh, attributes, metadata);
  VolumeMesh moved = mesh;
  VolumeAttributes scaled = attributes;
  const double scale = 1 / millimetres_per(metadata.unit);
  io::move_points(moved.points, scale, metadata.space);
  io::scale_lengths(scaled.point, scale);
  io::scale_lengths(scaled.cell, scale);
  write_files(path, format, moved, scaled, metadata);
}

}  // namespace

const VolumeFormat* find_volume_format(const std::filesystem::path& path) {
  if (const VolumeFormat* format = find_format(volume_formats(), path)) return format;
  const std::string name = lower((path.has_filename() ? path : path.parent_path()).filename().string());
  for (const VolumeFormat& format : volume_formats()) {
    if (format.is_folder() && name.ends_with(lower(format.folder))) return &format;
  }
  return nullptr;
}

std::string written_volume_files() {
  return listed_volume_files([](const VolumeFormat& f) { return f.is_written(); });
}

std::string read_volume_files() {
  return listed_volume_files([](const VolumeFormat& f) { return f.is_read(); });
}

const VolumeFormat& volume_output_format(const std::filesystem::path& path) {
  const VolumeFormat* format = find_volume_format(path);
  if (format != nullptr && format->is_written()) return *format;
  throw Unsupported(path.string() + ": \"" + extension_of(path) + "\" is not supported; write the volume mesh as " +
                    written_volume_files());
}

void write_volume(const std::filesystem::path& path, const VolumeMesh& mesh, const VolumeMetadata& metadata,
                  const VolumeAttributes& attributes, const VolumeWriteOptions& options) {
  const VolumeFormat& format = volume_output_format(path);
  if (!options.split_cells) check_cells(path, format, mesh);
  try {
    check_writable(mesh, attributes);
    if (options.split_cells) {
      const SplitCells split = split_cells(mesh);
      write_converted(path, format, split.mesh, split_attributes(attributes, split.cell_origins), metadata);
    } else {
      write_converted(path, format, mesh, attributes, metadata);
    }
  } catch (const InvalidInput& error) {
    throw InvalidInput(path.string() + ": " + error.what());
  }
}

LoadedVolume parse_volume(std::string_view content, const VolumeFormat& format, const std::string& source) {
  if (format.is_read()) return format.parse(content, source);
  throw Unsupported(source + ": " + format.name + " is written, not read; volume meshes are read from " +
                    read_volume_files());
}

LoadedVolume read_volume(const std::filesystem::path& path) {
  const VolumeFormat* format = find_volume_format(path);
  if (format == nullptr || !format->is_read())
    throw Unsupported(path.string() + ": volume meshes are read from " + read_volume_files());
  return format->parse(read_file(path), path.string());
}

}  // namespace vmesh

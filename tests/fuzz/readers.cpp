#include "readers.h"

#include <algorithm>
#include <stdexcept>

#include "vmesh/core/error.h"
#include "vmesh/image/image_io.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/io/volume_io.h"
#include "vmesh/mesh/volume_faces.h"

namespace vmesh::testing {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw std::logic_error(what);
}

/// Whether a message names the file, is printable and not too long.
void check_message(const std::string& message, const std::string& source) {
  constexpr std::size_t kLongest = 1000;
  require(message.find(source) != std::string::npos, "the message does not name the file: " + message);
  require(message.size() <= kLongest, "the message is too long: " + message);
  require(std::none_of(message.begin(), message.end(),
                       [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f; }),
          "there are control characters in the message: " + message);
}

template <class Action>
Verdict verdict_of(const std::string& source, Action&& action) {
  try {
    action();
    return Verdict::read;
  } catch (const InvalidInput& error) {
    check_message(error.what(), source);
  } catch (const Unsupported& error) {
    check_message(error.what(), source);
  }
  return Verdict::refused;
}

void check(const RawCenterline& raw) {
  const auto count = raw.nodes.size();
  for (const auto& [a, b] : raw.segments) require(a < count && b < count, "a segment without its node");
  require(std::is_sorted(raw.path_starts.begin(), raw.path_starts.end()), "paths out of order");
  for (const Index start : raw.path_starts) require(start < raw.segments.size(), "a path without its segment");
  for (const EndSection& section : raw.end_sections) require(section.node < count, "a flat end without its node");
  require(raw.node_numbers.empty() || raw.node_numbers.size() == count, "nodes without numbers");
  require(raw.segment_numbers.empty() || raw.segment_numbers.size() == raw.segments.size(), "segments without numbers");
}

Verdict read_centerline_as(const CenterlineFormat& format, std::string_view content) {
  const std::string source = "input.";
  return verdict_of(source, [&] {
    std::string_view second;
    if (format.second_file) {
      const std::size_t end = std::min(content.find(kCsvSeparator), content.size());
      second = content.substr(std::min(end + 1, content.size()));
      content = content.substr(0, end);
    }
    CenterlineReadOptions options;
    if (format.extensions.front() == ".pth" || format.extensions.front() == ".obj") options.radius = 1.5;
    if (format.extensions.front() == ".gxl") options.voxel_size = Vec3(1, 1, 2);
    RawCenterline raw = parse_centerline(content, format, source, options, second);
    check(raw);
    std::vector<std::string> warnings;
    const CleanedCenterline cleaned = clean(convert_read(std::move(raw), options, {}, {}, warnings));
    require(cleaned.raw_node.size() == cleaned.centerline.nodes().size(), "cleaned nodes of unknown origin");
    for (const EndSection& section : cleaned.end_sections)
      require(section.node < cleaned.raw_node.size() && cleaned.centerline.degree(section.node) == 1,
              "a flat end where no vessel ends");
  });
}

void check(const std::vector<MeshAttribute>& attributes, std::size_t count) {
  for (const auto& a : attributes) require(a.values.size() == count, "an attribute of the wrong length");
}

Verdict read_surface_as(const SurfaceFormat& format, std::string_view content) {
  const std::string source = "input.";
  return verdict_of(source, [&] {
    const LoadedSurface surface = parse_surface(content, format, source);
    require(!surface.mesh.faces.empty(), "a surface without a face");
    for (const Vec3& p : surface.mesh.vertices) require(p.allFinite(), "a vertex that is not finite");
    for (const Triangle& face : surface.mesh.faces) {
      for (const Index v : face) require(v < surface.mesh.vertices.size(), "a face without its vertex");
    }
    check(surface.attributes.vertex, surface.mesh.vertices.size());
    check(surface.attributes.face, surface.mesh.faces.size());
  });
}

Verdict read_volume_as(const VolumeFormat& format, std::string_view content) {
  const std::string source = "input.";
  return verdict_of(source, [&] {
    const LoadedVolume volume = parse_volume(content, format, source);
    require(volume.mesh.cell_count() > 0, "a volume mesh without a cell");
    for (const Vec3& p : volume.mesh.points) require(p.allFinite(), "a point that is not finite");
    check_volume_mesh(volume.mesh);
    sides_of_boundary(volume.mesh);
    check(volume.attributes.point, volume.mesh.points.size());
    check(volume.attributes.cell, volume.mesh.cell_count());
  });
}

Verdict read_image_as(std::string_view content, std::string_view ending) {
  const std::string source = "input" + std::string(ending);
  return verdict_of(source, [&] {
    const VoxelImage image = parse_image(content, source, {.segments = {"tumor"}, .labels = {2}}).image;
    require(image.values.size() == image.size[0] * image.size[1] * image.size[2], "voxels that are not there");
    require(image.origin.allFinite() && image.steps.allFinite(), "an image without a place");
  });
}

MakeSeeds seeds_of(const std::map<std::string, MakeSeeds>& seeds, const std::string& ending) {
  const auto found = seeds.find(ending);
  require(found != seeds.end(), "there are no seeds of " + ending);
  return found->second;
}

/// ".nii.gz" as a word: "nii_gz".
std::string name_of(const std::string& ending) {
  std::string name = ending.substr(1);
  std::ranges::replace(name, '.', '_');
  return name;
}

std::vector<Reader> make_readers() {
  std::vector<Reader> all;
  for (const CenterlineFormat& format : centerline_formats()) {
    if (!format.parse && !format.parse_pair) continue;
    const std::string& ending = format.extensions.front();
    all.push_back({name_of(ending), ending, [&format](auto content) { return read_centerline_as(format, content); },
                   seeds_of(centerline_seeds(), ending)});
  }
  for (const SurfaceFormat& format : surface_formats()) {
    if (!format.parse) continue;
    const std::string& ending = format.extensions.front();
    all.push_back({(find_centerline_format("t" + ending) ? "surface_" : "") + name_of(ending), ending,
                   [&format](auto content) { return read_surface_as(format, content); },
                   seeds_of(surface_seeds(), ending)});
  }
  for (const VolumeFormat& format : volume_formats()) {
    if (!format.parse) continue;
    const std::string& ending = format.extensions.front();
    all.push_back({"volume_" + name_of(ending), ending,
                   [&format](auto content) { return read_volume_as(format, content); },
                   seeds_of(volume_seeds(), ending)});
  }
  for (const std::string& ending :
       extensions_of(image_formats(), [](const auto& f) { return (f.parse_header && !f.in_two_files) || f.read; }))
    all.push_back({name_of(ending), ending, [ending](auto content) { return read_image_as(content, ending); },
                   seeds_of(image_seeds(), ending)});
  return all;
}

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = make_readers();
  return all;
}

const Reader& reader_named(std::string_view name) {
  const auto found = std::ranges::find(readers(), name, &Reader::name);
  if (found == readers().end()) throw std::invalid_argument("there is no reader " + std::string(name));
  return *found;
}

}  // namespace vmesh::testing

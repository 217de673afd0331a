#include "readers.h"

#include <algorithm>
#include <stdexcept>

#include "vmesh/core/error.h"
#include "vmesh/image/image_io.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"

#include "seeds.h"

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

template <CenterlineFormat Format>
Verdict read_centerline_as(std::string_view content) {
  const std::string source = "input.";
  return verdict_of(source, [&] {
    std::string_view second;
    if (Format == CenterlineFormat::csv) {
      const std::size_t end = std::min(content.find(kCsvSeparator), content.size());
      second = content.substr(std::min(end + 1, content.size()));
      content = content.substr(0, end);
    }
    CenterlineReadOptions options;
    if (Format == CenterlineFormat::pth) options.radius = 1.5;
    if (Format == CenterlineFormat::gxl) options.voxel_size = Vec3(1, 1, 2);
    RawCenterline raw = parse_centerline(content, Format, source, options, second);
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

template <SurfaceFormat Format>
Verdict read_surface_as(std::string_view content) {
  const std::string source = "input.";
  return verdict_of(source, [&] {
    const LoadedSurface surface = parse_surface(content, Format, source);
    require(!surface.mesh.faces.empty(), "a surface without a face");
    for (const Vec3& p : surface.mesh.vertices) require(p.allFinite(), "a vertex that is not finite");
    for (const Triangle& face : surface.mesh.faces) {
      for (const Index v : face) require(v < surface.mesh.vertices.size(), "a face without its vertex");
    }
    check(surface.attributes.vertex, surface.mesh.vertices.size());
    check(surface.attributes.face, surface.mesh.faces.size());
  });
}

Verdict read_image_as(std::string_view content, std::string_view ending) {
  const std::string source = "input" + std::string(ending);
  return verdict_of(source, [&] {
    const VoxelImage image = parse_image(content, source).image;
    require(image.values.size() == image.size[0] * image.size[1] * image.size[2], "voxels that are not there");
    require(image.origin.allFinite() && image.steps.allFinite(), "an image without a place");
  });
}

constexpr Reader kReaders[] = {
    {"swc", ".swc", read_centerline_as<CenterlineFormat::swc>, swc_seeds},
    {"vmv", ".vmv", read_centerline_as<CenterlineFormat::vmv>, vmv_seeds},
    {"json", ".json", read_centerline_as<CenterlineFormat::json>, json_seeds},
    {"csv", ".csv", read_centerline_as<CenterlineFormat::csv>, csv_seeds},
    {"vtk", ".vtk", read_centerline_as<CenterlineFormat::vtk>, vtk_seeds},
    {"vtp", ".vtp", read_centerline_as<CenterlineFormat::vtp>, vtp_seeds},
    {"ctgr", ".ctgr", read_centerline_as<CenterlineFormat::ctgr>, ctgr_seeds},
    {"pth", ".pth", read_centerline_as<CenterlineFormat::pth>, pth_seeds},
    {"gxl", ".gxl", read_centerline_as<CenterlineFormat::gxl>, gxl_seeds},
    {"amira", ".am", read_centerline_as<CenterlineFormat::amira>, amira_seeds},
    {"network", ".dat", read_centerline_as<CenterlineFormat::network>, network_seeds},
    {"markups", ".mrk.json", read_centerline_as<CenterlineFormat::json>, markups_seeds},
    {"surface_vtp", ".vtp", read_surface_as<SurfaceFormat::vtp>, surface_vtp_seeds},
    {"surface_vtk", ".vtk", read_surface_as<SurfaceFormat::vtk>, surface_vtk_seeds},
    {"ply", ".ply", read_surface_as<SurfaceFormat::ply>, ply_seeds},
    {"stl", ".stl", read_surface_as<SurfaceFormat::stl>, stl_seeds},
    {"obj", ".obj", read_surface_as<SurfaceFormat::obj>, obj_seeds},
    {"off", ".off", read_surface_as<SurfaceFormat::off>, off_seeds},
    {"nii", ".nii", [](std::string_view content) { return read_image_as(content, ".nii"); }, nii_seeds},
    {"nii_gz", ".nii.gz", [](std::string_view content) { return read_image_as(content, ".nii.gz"); }, nii_gz_seeds},
    {"nrrd", ".nrrd", [](std::string_view content) { return read_image_as(content, ".nrrd"); }, nrrd_seeds},
    {"mha", ".mha", [](std::string_view content) { return read_image_as(content, ".mha"); }, mha_seeds},
};

}  // namespace

std::span<const Reader> readers() { return kReaders; }

const Reader& reader_named(std::string_view name) {
  const auto found = std::ranges::find(kReaders, name, &Reader::name);
  if (found == std::end(kReaders)) throw std::invalid_argument("there is no reader " + std::string(name));
  return *found;
}

}  // namespace vmesh::testing

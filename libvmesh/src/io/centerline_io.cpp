#include "vmesh/io/centerline_io.h"

#include <algorithm>
#include <istream>
#include <iterator>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"

namespace vmesh {

const CenterlineFormat* find_centerline_format(const std::filesystem::path& path) {
  return find_format(centerline_formats(), path);
}

const CenterlineFormat& centerline_format(const std::filesystem::path& path) {
  if (const CenterlineFormat* format = find_centerline_format(path)) return *format;
  throw Unsupported(path.string() + ": centerlines are " +
                    listed(extensions_of(centerline_formats(), [](const auto&) { return true; })) + "; \"" +
                    extension_of(path) + "\" is not supported");
}

const CenterlineFormat& centerline_output_format(const std::filesystem::path& path) {
  const CenterlineFormat* format = find_centerline_format(path);
  if (format != nullptr && format->is_written()) return *format;
  const std::string what = format != nullptr
                               ? "files of this kind are read, not written; write the centerline as "
                               : "\"" + extension_of(path) + "\" is not supported; write the centerline as ";
  throw Unsupported(path.string() + ": " + what +
                    listed(extensions_of(centerline_formats(), [](const auto& f) { return f.is_written(); })));
}

std::vector<std::string> options_without_effect(const CenterlineReadOptions& options,
                                                const std::vector<std::filesystem::path>& paths) {
  std::vector<std::string> given;
  if (!options.radius_array.empty()) given.push_back("radius-array");
  if (options.voxel_size) given.push_back("voxel-size");
  if (options.radius && paths.empty()) given.push_back("radius");  // which act on every format
  if (options.tolerance && paths.empty()) given.push_back("tolerance");
  for (const std::filesystem::path& path : paths) {
    for (const std::string& option : centerline_format(path).options) std::erase(given, option);
  }
  return given;
}

std::filesystem::path second_file_to_read(const CenterlineFormat& format, const std::filesystem::path& path) {
  const std::filesystem::path second = format.second_file(path);
  const std::filesystem::path others = format.others_second_file ? format.others_second_file(path) : "";
  std::error_code error;
  return !others.empty() && std::filesystem::exists(others, error) && !std::filesystem::exists(second, error) ? others
                                                                                                              : second;
}

namespace {

RawCenterline read_file_of_centerline(const std::filesystem::path& path, const CenterlineReadOptions& options) {
  const CenterlineFormat& format = centerline_format(path);
  if (format.read) return format.read(path);
  if (format.parse) return format.parse(read_file(path), path.string(), options);
  if (!format.parse_pair) refuse_without(format.needs, path);
  const std::filesystem::path second = second_file_to_read(format, path);
  const std::string content = read_file(path);
  return format.parse_pair(content, read_file(second), path.string(), second.string(), options);
}

}  // namespace

RawCenterline parse_centerline(std::string_view content, const CenterlineFormat& format, const std::string& source,
                               const CenterlineReadOptions& options, std::string_view csv_segments) {
  if (format.parse) return format.parse(content, source, options);
  if (format.parse_pair)
    return format.parse_pair(content, csv_segments, source, csv_segments_path(source).string(), options);
  throw Unsupported(source + ": files of this kind are read by their names only");
}

RawCenterline read_centerline(const std::filesystem::path& path, const CenterlineReadOptions& options) {
  return read_centerline(std::vector{path}, options);
}

RawCenterline read_centerline(std::istream& in, const CenterlineFormat& format, const std::string& source,
                              const CenterlineReadOptions& options) {
  const std::string content(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) throw ReadError(source + ": cannot be read");
  if (content.empty()) throw InvalidInput(source + ": the input is empty");
  return parse_centerline(content, format, source, options);
}

RawCenterline read_centerline(const std::vector<std::filesystem::path>& paths, const CenterlineReadOptions& options) {
  if (const auto without = options_without_effect(options, paths); !paths.empty() && !without.empty())
    throw InvalidInput(paths.front().string() + ": the option " + without.front() +
                       " has no effect on files of this kind");
  std::vector<RawCenterline> files;
  for (const std::filesystem::path& path : paths) files.push_back(read_file_of_centerline(path, options));
  return merge(std::move(files));
}

RawCenterline names_of(RawCenterline raw) {
  // {} would empty them and keep their memory.
  raw.nodes = std::vector<CenterlineNode>();
  raw.segments = std::vector<CenterlineSegment>();
  raw.path_starts = std::vector<Index>();
  raw.end_sections = std::vector<EndSection>();
  return raw;
}

RawCenterline convert_read(RawCenterline raw, const CenterlineReadOptions& options, std::optional<LengthUnit> unit,
                           std::optional<Space> space, std::vector<std::string>& warnings) {
  warnings.insert(warnings.end(), raw.warnings.begin(), raw.warnings.end());
  raw.warnings.clear();
  if (options.tolerance) raw.join_ends = *options.tolerance;
  const bool may_be_wrong = !unit && raw.unit != LengthUnit::um && raw.unit != LengthUnit::nm;
  raw = convert_to_internal(std::move(raw), unit, space, warnings);
  if (may_be_wrong) {
    if (const auto hint = implausible_radii(raw)) warnings.push_back(*hint);
  }
  if (!options.radius) return raw;
  if (!(*options.radius > 0)) throw InvalidInput("the radius given must be above 0");
  std::size_t given = 0;
  for (CenterlineNode& node : raw.nodes) {
    if (node.radius != 0) continue;
    node.radius = *options.radius;
    ++given;
  }
  if (given < raw.nodes.size()) {
    warnings.push_back(raw.source + ": " + std::to_string(raw.nodes.size() - given) +
                       " nodes have radii of their own, which they keep");
  }
  return raw;
}

LoadedCenterline load_centerline(const std::vector<std::filesystem::path>& paths,
                                 const CenterlineLoadOptions& options) {
  std::vector<std::string> warnings;
  RawCenterline raw =
      convert_read(read_centerline(paths, options.read), options.read, options.unit, options.space, warnings);
  CleanedCenterline cleaned = clean(raw, options.cleaning);
  return {std::move(cleaned), std::move(warnings), names_of(std::move(raw))};
}

LoadedCenterline load_centerline(const std::filesystem::path& path, const CenterlineLoadOptions& options) {
  return load_centerline(std::vector{path}, options);
}

namespace {

/// What the axes of internal coordinates are multiplied by for those of the file.
Vec3 axes_of(const CenterlineMetadata& metadata) {
  const double scale = 1 / millimetres_per(metadata.unit);
  return metadata.space == Space::ras ? Vec3(-scale, -scale, scale) : Vec3(scale, scale, scale);
}

Centerline converted(const Centerline& centerline, const CenterlineMetadata& metadata) {
  const Vec3 axes = axes_of(metadata);
  const double scale = axes.z();
  std::vector<CenterlineNode> nodes = centerline.nodes();
  for (CenterlineNode& node : nodes) {
    node.position = node.position.cwiseProduct(axes);
    node.radius *= scale;
  }
  return {std::move(nodes), centerline.segments()};
}

std::vector<EndSection> converted(std::vector<EndSection> sections, const CenterlineMetadata& metadata) {
  const Vec3 axes = axes_of(metadata);
  for (EndSection& section : sections) {
    section.center = section.center.cwiseProduct(axes);
    section.normal = section.normal.cwiseProduct(axes / axes.z());
    section.area *= axes.z() * axes.z();
    for (Vec3& p : section.ring) p = p.cwiseProduct(axes);  // half a turn about z at most: still counter-clockwise
  }
  return sections;
}

void check(const std::vector<EndSection>& sections, const Centerline& centerline) {
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const EndSection& section = sections[i];
    const std::string name = "flat end " + std::to_string(i) + ": ";
    if (section.node >= centerline.nodes().size() || centerline.degree(section.node) != 1)
      throw InvalidInput(name + "node " + std::to_string(section.node) + " is no end of the centerline");
    if (const std::string problem = problem_of(section); !problem.empty()) throw InvalidInput(name + problem);
  }
}

}  // namespace

void write_centerline(const std::filesystem::path& path, const Centerline& given, const CenterlineMetadata& metadata,
                      const std::vector<EndSection>& given_sections) {
  const bool converts = metadata.unit != LengthUnit::mm || metadata.space != Space::lps;
  check(given_sections, given);
  const Centerline& centerline = converts ? converted(given, metadata) : given;
  const std::vector<EndSection>& sections = converts ? converted(given_sections, metadata) : given_sections;
  const CenterlineFormat& format = centerline_output_format(path);
  if (format.trees_only && centerline.cycle_rank() > 0) {
    throw Unsupported(
        path.string() + ": " + format.name + " holds trees only and this centerline has " +
        std::to_string(centerline.cycle_rank()) + " independent loops; write it as " +
        listed(extensions_of(centerline_formats(), [](const auto& f) { return f.is_written() && !f.trees_only; })));
  }
  const std::filesystem::path second_path = format.second_file ? format.second_file(path) : std::filesystem::path();
  AtomicFile file(path);
  if (format.write) {
    format.write(file.stream(), centerline, metadata, sections);
  } else {
    AtomicFile second(second_path);
    format.write_pair(file.stream(), second.stream(), centerline, metadata);
    second.commit();
  }
  file.commit();
}

}  // namespace vmesh

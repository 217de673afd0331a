#include "vmesh/io/centerline_io.h"

#include <istream>
#include <iterator>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"

#include "formats.h"
#include "text.h"

namespace vmesh {

std::optional<CenterlineFormat> find_centerline_format(const std::filesystem::path& path) {
  const std::string extension = io::lower(path.extension().string());
  if (extension == ".swc") return CenterlineFormat::swc;
  if (extension == ".vtp") return CenterlineFormat::vtp;
  if (extension == ".json") return CenterlineFormat::json;
  if (extension == ".csv") return CenterlineFormat::csv;
  if (extension == ".vmv") return CenterlineFormat::vmv;
  if (extension == ".vtk") return CenterlineFormat::vtk;
  if (extension == ".ctgr") return CenterlineFormat::ctgr;
  if (extension == ".pth") return CenterlineFormat::pth;
  if (extension == ".gxl" || extension == ".xml") return CenterlineFormat::gxl;
  if (extension == ".am") return CenterlineFormat::amira;
  if (extension == ".dat") return CenterlineFormat::network;
  if (extension == ".h5") return CenterlineFormat::hdf5;
  return std::nullopt;
}

CenterlineFormat centerline_format(const std::filesystem::path& path) {
  if (const auto format = find_centerline_format(path)) return *format;
  throw Unsupported(
      path.string() +
      ": centerlines are .swc, .vtp, .json, .csv, .vmv, .vtk, .mrk.json, .ctgr, .pth, .gxl, .am, .dat or .h5; "
      "\"" +
      io::lower(path.extension().string()) + "\" is not supported");
}

CenterlineFormat centerline_output_format(const std::filesystem::path& path) {
  const CenterlineFormat format = centerline_format(path);
  const bool of_slicer = io::lower(path.stem().extension().string()) == ".mrk";
  const bool is_written = format == CenterlineFormat::swc || format == CenterlineFormat::vtp ||
                          (format == CenterlineFormat::json && !of_slicer) || format == CenterlineFormat::csv;
  if (!is_written) {
    throw Unsupported(path.string() +
                      ": files of this kind are read, not written; write the centerline as .json, .csv or .vtp");
  }
  return format;
}

std::filesystem::path csv_segments_path(const std::filesystem::path& nodes_path) {
  std::filesystem::path stem = nodes_path.stem();
  if (io::lower(stem.extension().string()) == ".nodes") stem = stem.stem();
  return std::filesystem::path(nodes_path).replace_filename(stem.string() + ".segments.csv");
}

namespace {

void check_is_nodes_file(const std::filesystem::path& path) {
  if (io::lower(path.stem().extension().string()) != ".segments") return;
  throw InvalidInput(path.string() + ": this names the second file of a CSV pair; give the one with the nodes");
}

}  // namespace

RawCenterline parse_centerline(std::string_view content, CenterlineFormat format, const std::string& source,
                               const CenterlineReadOptions& options, std::string_view csv_segments) {
  switch (format) {
    case CenterlineFormat::swc:
      return io::parse_swc(content, source);
    case CenterlineFormat::vtp:
      return io::parse_centerline_vtp(content, source, options);
    case CenterlineFormat::json:
      return io::parse_centerline_json(content, source, options);
    case CenterlineFormat::csv:
      return io::parse_centerline_csv(content, csv_segments, source);
    case CenterlineFormat::vmv:
      return io::parse_vmv(content, source);
    case CenterlineFormat::vtk:
      return io::parse_centerline_vtk(content, source, options);
    case CenterlineFormat::ctgr:
      return io::parse_contours(content, source);
    case CenterlineFormat::pth:
      return io::parse_path(content, source, options);
    case CenterlineFormat::gxl:
      return io::parse_gxl(content, source, options);
    case CenterlineFormat::amira:
      return io::parse_amira(content, source, options);
    case CenterlineFormat::network:
      return io::parse_network(content, source);
    case CenterlineFormat::hdf5:
      throw Unsupported(source + ": HDF5 is read from files only");
  }
  throw Unsupported(source + ": unknown centerline format");
}

RawCenterline read_centerline(const std::filesystem::path& path, const CenterlineReadOptions& options) {
  const CenterlineFormat format = centerline_format(path);
  if (format == CenterlineFormat::hdf5) return io::read_hdf5_network(path);
  const std::string content = read_file(path);
  std::string segments;
  if (format == CenterlineFormat::csv) {
    check_is_nodes_file(path);
    segments = read_file(csv_segments_path(path));
  }
  return parse_centerline(content, format, path.string(), options, segments);
}

RawCenterline read_centerline(std::istream& in, CenterlineFormat format, const std::string& source,
                              const CenterlineReadOptions& options) {
  const std::string content(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) throw ReadError(source + ": cannot be read");
  if (content.empty()) throw InvalidInput(source + ": the input is empty");
  return parse_centerline(content, format, source, options);
}

RawCenterline read_centerline(const std::vector<std::filesystem::path>& paths, const CenterlineReadOptions& options) {
  std::vector<RawCenterline> files;
  for (const std::filesystem::path& path : paths) files.push_back(read_centerline(path, options));
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
  const bool may_be_wrong = !unit && raw.unit != LengthUnit::um;
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

bool keeps_end_sections(CenterlineFormat format) {
  return format == CenterlineFormat::json || format == CenterlineFormat::vtp;
}

void write_centerline(const std::filesystem::path& path, const Centerline& given, const CenterlineMetadata& metadata,
                      const std::vector<EndSection>& given_sections) {
  const bool converts = metadata.unit != LengthUnit::mm || metadata.space != Space::lps;
  check(given_sections, given);
  const Centerline& centerline = converts ? converted(given, metadata) : given;
  const std::vector<EndSection>& sections = converts ? converted(given_sections, metadata) : given_sections;
  const CenterlineFormat format = centerline_output_format(path);
  if (format == CenterlineFormat::swc && centerline.cycle_rank() > 0) {
    throw Unsupported(path.string() + ": SWC holds trees only and this centerline has " +
                      std::to_string(centerline.cycle_rank()) + " independent loops; write it as .json, .csv or .vtp");
  }
  if (format == CenterlineFormat::csv) check_is_nodes_file(path);
  AtomicFile file(path);
  switch (format) {
    case CenterlineFormat::swc:
      io::write_swc(file.stream(), centerline, metadata);
      break;
    case CenterlineFormat::vtp:
      io::write_centerline_vtp(file.stream(), centerline, metadata, sections);
      break;
    case CenterlineFormat::json:
      io::write_centerline_json(file.stream(), centerline, metadata, sections);
      break;
    case CenterlineFormat::csv: {
      AtomicFile segments(csv_segments_path(path));
      io::write_centerline_csv(file.stream(), segments.stream(), centerline, metadata);
      segments.commit();
      break;
    }
    default:
      break;  // refused above
  }
  file.commit();
}

}  // namespace vmesh

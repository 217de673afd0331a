#include "vmesh/io/centerline_io.h"

#include <istream>
#include <iterator>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"

#include "formats.h"
#include "text.h"

namespace vmesh {

CenterlineFormat centerline_format(const std::filesystem::path& path) {
  const std::string extension = io::lower(path.extension().string());
  if (extension == ".swc") return CenterlineFormat::swc;
  if (extension == ".vtp") return CenterlineFormat::vtp;
  if (extension == ".json") return CenterlineFormat::json;
  if (extension == ".csv") return CenterlineFormat::csv;
  if (extension == ".vmv") return CenterlineFormat::vmv;
  if (extension == ".vtk") return CenterlineFormat::vtk;
  throw Unsupported(path.string() + ": centerlines are .swc, .vtp, .json, .csv, .vmv or .vtk; \"" + extension +
                    "\" is not supported");
}

CenterlineFormat centerline_output_format(const std::filesystem::path& path) {
  const CenterlineFormat format = centerline_format(path);
  if (format == CenterlineFormat::vmv || format == CenterlineFormat::vtk) {
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
      return io::parse_centerline_vtp(content, source, options.radius_array);
    case CenterlineFormat::json:
      return io::parse_centerline_json(content, source);
    case CenterlineFormat::csv:
      return io::parse_centerline_csv(content, csv_segments, source);
    case CenterlineFormat::vmv:
      return io::parse_vmv(content, source);
    case CenterlineFormat::vtk:
      return io::parse_centerline_vtk(content, source, options.radius_array);
  }
  throw Unsupported(source + ": unknown centerline format");
}

RawCenterline read_centerline(const std::filesystem::path& path, const CenterlineReadOptions& options) {
  const CenterlineFormat format = centerline_format(path);
  const std::string content = io::read_file(path);
  std::string segments;
  if (format == CenterlineFormat::csv) {
    check_is_nodes_file(path);
    segments = io::read_file(csv_segments_path(path));
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

LoadedCenterline load_centerline(const std::filesystem::path& path, const CenterlineLoadOptions& options) {
  RawCenterline raw = read_centerline(path, options.read);
  std::vector<std::string> warnings = std::move(raw.warnings);
  raw.warnings.clear();
  raw = convert_to_internal(std::move(raw), options.unit, options.space, warnings);
  return {clean(raw, options.cleaning), std::move(warnings)};
}

void write_centerline(const std::filesystem::path& path, const Centerline& centerline,
                      const CenterlineMetadata& metadata) {
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
      io::write_centerline_vtp(file.stream(), centerline, metadata);
      break;
    case CenterlineFormat::json:
      io::write_centerline_json(file.stream(), centerline, metadata);
      break;
    case CenterlineFormat::csv: {
      AtomicFile segments(csv_segments_path(path));
      io::write_centerline_csv(file.stream(), segments.stream(), centerline, metadata);
      segments.commit();
      break;
    }
    case CenterlineFormat::vmv:
    case CenterlineFormat::vtk:
      break;  // refused above
  }
  file.commit();
}

}  // namespace vmesh

// NRRD (https://teem.sourceforge.net/nrrd/format.html), in one file or two, raw or gzip.
#include <charconv>
#include <cmath>
#include <map>

#include "vmesh/core/error.h"

#include "image_header.h"

namespace vmesh::image {
namespace {

using Entries = std::map<std::string, std::string>;

NumberType number_type(const std::string& word, const std::string& name) {
  static const std::map<std::string, NumberType> kTypes = {{"signed char", NumberType::i8},
                                                           {"int8", NumberType::i8},
                                                           {"int8_t", NumberType::i8},
                                                           {"uchar", NumberType::u8},
                                                           {"unsigned char", NumberType::u8},
                                                           {"uint8", NumberType::u8},
                                                           {"uint8_t", NumberType::u8},
                                                           {"short", NumberType::i16},
                                                           {"short int", NumberType::i16},
                                                           {"signed short", NumberType::i16},
                                                           {"signed short int", NumberType::i16},
                                                           {"int16", NumberType::i16},
                                                           {"int16_t", NumberType::i16},
                                                           {"ushort", NumberType::u16},
                                                           {"unsigned short", NumberType::u16},
                                                           {"unsigned short int", NumberType::u16},
                                                           {"uint16", NumberType::u16},
                                                           {"uint16_t", NumberType::u16},
                                                           {"int", NumberType::i32},
                                                           {"signed int", NumberType::i32},
                                                           {"int32", NumberType::i32},
                                                           {"int32_t", NumberType::i32},
                                                           {"uint", NumberType::u32},
                                                           {"unsigned int", NumberType::u32},
                                                           {"uint32", NumberType::u32},
                                                           {"uint32_t", NumberType::u32},
                                                           {"longlong", NumberType::i64},
                                                           {"long long", NumberType::i64},
                                                           {"long long int", NumberType::i64},
                                                           {"signed long long", NumberType::i64},
                                                           {"signed long long int", NumberType::i64},
                                                           {"int64", NumberType::i64},
                                                           {"int64_t", NumberType::i64},
                                                           {"ulonglong", NumberType::u64},
                                                           {"unsigned long long", NumberType::u64},
                                                           {"unsigned long long int", NumberType::u64},
                                                           {"uint64", NumberType::u64},
                                                           {"uint64_t", NumberType::u64},
                                                           {"float", NumberType::f32},
                                                           {"double", NumberType::f64}};
  const auto found = kTypes.find(word);
  if (found == kTypes.end()) throw Unsupported(name + ": voxels of type " + cited(word) + " are not supported");
  return found->second;
}

constexpr const char* kDataFile = "data file";

/// Adds what a line like "Segment3_Name:=portal" says of a segment; other lines are left alone.
void read_segment_line(std::string_view key, std::string_view value, std::map<std::uint64_t, Entries>& segments) {
  constexpr std::string_view kSegment = "Segment";
  if (!key.starts_with(kSegment)) return;
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(key.data() + kSegment.size(), key.data() + key.size(), number);
  if (error != std::errc() || end == key.data() + key.size() || *end != '_') return;
  const std::string_view property(end + 1, static_cast<std::size_t>(key.data() + key.size() - end - 1));
  if (property == "Name" || property == "LabelValue" || property == "Layer")
    segments[number].insert_or_assign(std::string(property), trimmed(value));
}

/// Lines up to the empty one, or, if the voxels are in another file, to the end; keys in lower case, and values but for
/// names of files.
Entries entries_of(std::string_view bytes, const std::string& name, std::uint64_t& header_end,
                   std::map<std::uint64_t, Entries>& segments) {
  Entries entries;
  std::string_view rest = bytes, line;
  if (!bytes.starts_with("NRRD000") || !take_line(rest, line))
    throw InvalidInput(name + ": this is not an NRRD file: it does not begin with a line such as NRRD0004");
  while (take_line(rest, line) && !line.empty()) {
    const std::size_t colon = line.find(':');
    if (line.front() == '#' || colon == std::string_view::npos) continue;
    if (line.substr(colon).starts_with(":=")) {
      read_segment_line(line.substr(0, colon), line.substr(colon + 2), segments);
      continue;
    }
    const std::string key = folded(line.substr(0, colon));
    const std::string_view value = line.substr(colon + 1);
    if (key == kDataFile || key == "datafile") {
      entries[kDataFile] = trimmed(value);
    } else {
      entries[key] = folded(value);
    }
  }
  if (!line.empty() && !entries.contains(kDataFile))
    throw InvalidInput(name + ": the header has no end (an empty line)");
  header_end = bytes.size() - rest.size();
  return entries;
}

const std::string& required(const Entries& entries, const char* key, const std::string& name) {
  const auto found = entries.find(key);
  if (found == entries.end()) throw InvalidInput(name + ": the header has no line \"" + key + "\"");
  return found->second;
}

std::string optional(const Entries& entries, const char* key) {
  const auto found = entries.find(key);
  return found == entries.end() ? std::string() : found->second;
}

void set_data(ImageHeader& header, const Entries& entries, std::uint64_t header_end, const std::string& name) {
  for (const char* key : {"line skip", "lineskip"})
    if (!optional(entries, key).empty() && optional(entries, key) != "0")
      throw Unsupported(name + ": the header's \"" + key + "\" is not supported; store the image anew");
  const std::string& encoding = required(entries, "encoding", name);
  header.packed = encoding == "gzip" || encoding == "gz";
  if (!header.packed && encoding != "raw")
    throw Unsupported(name + ": encoding " + cited(encoding) + " is not supported; store the image raw or with gzip");
  if (entries.contains(kDataFile)) header.data_file = one_data_file(optional(entries, kDataFile), name);
  set_data_begin(header, header.data_file.empty() ? header_end : 0,
                 optional(entries, entries.contains("byteskip") ? "byteskip" : "byte skip"), name, "byte skip");
  const std::string endian = optional(entries, "endian");
  header.big_endian = endian == "big";
  if (endian.empty() && size_of(header.type) > 1) throw InvalidInput(name + ": the header has no line \"endian\"");
}

/// Segments that overlap are in layers, along an axis in front of the others. Takes that out of `sizes`.
void take_layers(ImageHeader& header, std::vector<double>& sizes, const std::string& kinds, const std::string& name) {
  if (sizes.size() != 4 || header.segments.empty() || !kinds.starts_with("list")) return;
  if (!(sizes[0] >= 1 && sizes[0] <= ImageHeader::kMostLayers) || sizes[0] != std::floor(sizes[0]))
    throw InvalidInput(name + ": the header gives no valid number of layers of segments");
  header.layers = static_cast<std::uint64_t>(sizes[0]);
  sizes.erase(sizes.begin());
}

/// The segments that a file of 3D Slicer names. In older ones each is a layer, with the value 1.
std::vector<ImageSegment> segments_of(const std::map<std::uint64_t, Entries>& lines, const std::string& name) {
  std::vector<ImageSegment> segments;
  for (const auto& line : lines) {
    const std::uint64_t number = line.first;
    const Entries& entries = line.second;
    const auto integer = [&](const char* key, double otherwise) {
      const std::vector<double> numbers = numbers_in(optional(entries, key), name, key);
      if (numbers.empty()) return otherwise;
      if (numbers.size() > 1 || !(std::abs(numbers[0]) <= 1e9) || numbers[0] != std::floor(numbers[0]))
        throw InvalidInput(name + ": segment " + std::to_string(number) + ": its " + key + " is not a number");
      return numbers[0];
    };
    const double layer = integer("Layer", static_cast<double>(segments.size()));
    if (layer < 0) throw InvalidInput(name + ": segment " + std::to_string(number) + ": its Layer is negative");
    segments.push_back({optional(entries, "Name"), integer("LabelValue", 1), static_cast<std::size_t>(layer)});
  }
  return segments;
}

void check_layers(const ImageHeader& header, const std::string& name) {
  for (const ImageSegment& segment : header.segments) {
    if (header.layers > 1 && segment.layer >= header.layers)
      throw InvalidInput(name + ": the segment " + cited(segment.name) + " is in layer " +
                         std::to_string(segment.layer) + "; there are " + std::to_string(header.layers));
  }
}

/// From the file's frame to LPS.
Eigen::DiagonalMatrix<double, 3> frame_of(ImageHeader& header, const std::string& space, const std::string& name) {
  if (space == "left-posterior-superior" || space == "lps") return {1, 1, 1};
  if (space == "right-anterior-superior" || space == "ras") return {-1, -1, 1};
  if (space == "left-anterior-superior" || space == "las") return {1, -1, 1};
  if (!space.empty() && space != "3")
    throw Unsupported(name + ": the space " + cited(space) + " is not supported; use LPS");
  header.warnings.push_back(name + ": names no patient frame (\"space\"); LPS is assumed");
  return {1, 1, 1};
}

void set_place(ImageHeader& header, const Entries& entries, const std::string& name) {
  std::string space = optional(entries, "space");
  if (space.empty()) space = optional(entries, "space dimension");
  const auto to_lps = frame_of(header, space, name);
  const std::string units = optional(entries, "space units");
  if (!units.empty() && units != "\"mm\" \"mm\" \"mm\"")
    throw Unsupported(name + ": space units " + cited(units) + " are not supported; store the image in mm");
  std::string directions = optional(entries, "space directions");
  while (directions.ends_with(" none")) directions.resize(directions.size() - 5);
  if (header.layers > 1 && directions.starts_with("none ")) directions.erase(0, 5);
  if (!directions.empty()) {
    const std::vector<double> numbers = numbers_in(directions, name, "space directions");
    if (numbers.size() != 9) throw InvalidInput(name + ": the header's \"space directions\" are not three vectors");
    for (int a = 0; a < 3; ++a)
      header.steps.col(a) = to_lps * Vec3(numbers[3 * a], numbers[3 * a + 1], numbers[3 * a + 2]);
  } else if (const std::vector<double> spacings = numbers_in(optional(entries, "spacings"), name, "spacings");
             spacings.size() >= 3) {
    header.steps = to_lps * Eigen::Matrix3d(Vec3(spacings[0], spacings[1], spacings[2]).asDiagonal());
  } else {
    header.warnings.push_back(name + ": gives no size of voxels (\"space directions\"); 1 mm is assumed");
  }
  const std::vector<double> origin = numbers_in(optional(entries, "space origin"), name, "space origin");
  if (!origin.empty() && origin.size() != 3)
    throw InvalidInput(name + ": the header's \"space origin\" is not a point");
  if (!origin.empty()) header.origin = to_lps * Vec3(origin[0], origin[1], origin[2]);
}

}  // namespace

ImageHeader parse_nrrd_header(std::string_view bytes, const std::string& name) {
  ImageHeader header;
  std::uint64_t header_end = 0;
  std::map<std::uint64_t, Entries> segments;
  const Entries entries = entries_of(bytes, name, header_end, segments);
  header.segments = segments_of(segments, name);
  std::vector<double> sizes = numbers_in(required(entries, "sizes", name), name, "sizes");
  const std::vector<double> dimension = numbers_in(required(entries, "dimension", name), name, "dimension");
  if (dimension.size() != 1 || dimension[0] != static_cast<double>(sizes.size()))
    throw InvalidInput(name + ": the header's \"dimension\" and \"sizes\" contradict each other");
  take_layers(header, sizes, optional(entries, "kinds"), name);
  check_layers(header, name);
  set_size(header, sizes, name);
  if (static_cast<double>(header.voxels()) * static_cast<double>(header.layers) > 1e17)
    throw InvalidInput(name + ": the header claims more than 10^17 numbers; it is broken");
  header.type = number_type(required(entries, "type", name), name);
  set_data(header, entries, header_end, name);
  set_place(header, entries, name);
  return header;
}

}  // namespace vmesh::image

// MetaImage (https://itk.org/Wiki/ITK/MetaIO/Documentation), in one file or two. Its frame is LPS.
#include <map>

#include "vmesh/core/error.h"

#include "image_header.h"

namespace vmesh::image {
namespace {

using Entries = std::map<std::string, std::string>;

NumberType number_type(const std::string& word, const std::string& name) {
  static const std::map<std::string, NumberType> kTypes = {
      {"met_char", NumberType::i8},        {"met_uchar", NumberType::u8},  {"met_short", NumberType::i16},
      {"met_ushort", NumberType::u16},     {"met_int", NumberType::i32},   {"met_uint", NumberType::u32},
      {"met_long", NumberType::i32},       {"met_ulong", NumberType::u32}, {"met_long_long", NumberType::i64},
      {"met_ulong_long", NumberType::u64}, {"met_float", NumberType::f32}, {"met_double", NumberType::f64}};
  const auto found = kTypes.find(word);
  if (found == kTypes.end()) throw Unsupported(name + ": voxels of type " + cited(word) + " are not supported");
  return found->second;
}

constexpr const char* kDataFile = "elementdatafile";

/// The lines up to ElementDataFile, the last one; keys in lower case, and values but for names of files.
Entries entries_of(std::string_view bytes, const std::string& name, std::uint64_t& header_end) {
  Entries entries;
  std::string_view rest = bytes, line;
  while (take_line(rest, line)) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) break;
    const std::string key = folded(line.substr(0, equals));
    const std::string_view value = line.substr(equals + 1);
    entries[key] = key == kDataFile ? std::string(trimmed(value)) : folded(value);
    if (key != kDataFile) continue;
    header_end = bytes.size() - rest.size();
    return entries;
  }
  throw InvalidInput(name + ": this is not a MetaImage file: its header does not end with a line ElementDataFile");
}

/// The value of the first key that occurs.
std::string value_of(const Entries& entries, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (const auto found = entries.find(key); found != entries.end()) return found->second;
  return {};
}

bool is_true(const std::string& value) { return value.starts_with('t') || value == "1"; }

std::vector<double> three(const Entries& entries, std::initializer_list<const char*> keys, const Vec3& otherwise,
                          const std::string& name) {
  std::vector<double> numbers = numbers_in(value_of(entries, keys), name, *keys.begin());
  if (numbers.empty()) return {otherwise.x(), otherwise.y(), otherwise.z()};
  if (numbers.size() != 3) throw InvalidInput(name + ": the header's \"" + *keys.begin() + "\" are not three numbers");
  return numbers;
}

/// HeaderSize counts from the beginning of the file, even if the voxels are in that of the header.
void set_data(ImageHeader& header, const Entries& entries, std::uint64_t header_end, const std::string& name) {
  header.packed = is_true(value_of(entries, {"compresseddata"}));
  const std::string& file = entries.at(kDataFile);
  if (folded(file) != "local") header.data_file = one_data_file(file, name);
  set_data_begin(header, 0, value_of(entries, {"headersize"}), name, "HeaderSize");
  if (header.data_file.empty() && header.data_begin == 0) header.data_begin = header_end;
}

void set_place(ImageHeader& header, const Entries& entries, const std::string& name) {
  std::vector<double> axes =
      numbers_in(value_of(entries, {"transformmatrix", "rotation", "orientation"}), name, "TransformMatrix");
  if (axes.empty()) axes = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (axes.size() != 9) throw InvalidInput(name + ": the header's TransformMatrix is not three vectors");
  const std::vector<double> spacing = three(entries, {"elementspacing", "elementsize"}, Vec3::Ones(), name);
  const std::vector<double> origin = three(entries, {"offset", "position", "origin"}, Vec3::Zero(), name);
  for (int a = 0; a < 3; ++a) {
    header.steps.col(a) = spacing[a] * Vec3(axes[3 * a], axes[3 * a + 1], axes[3 * a + 2]);
    header.origin[a] = origin[a];
  }
}

}  // namespace

ImageHeader parse_meta_header(std::string_view bytes, const std::string& name) {
  ImageHeader header;
  std::uint64_t header_end = 0;
  const Entries entries = entries_of(bytes, name, header_end);
  const std::vector<double> sizes = numbers_in(value_of(entries, {"dimsize"}), name, "DimSize");
  const std::vector<double> dimensions = numbers_in(value_of(entries, {"ndims"}), name, "NDims");
  if (dimensions.size() != 1 || dimensions[0] != static_cast<double>(sizes.size()))
    throw InvalidInput(name + ": the header's NDims and DimSize contradict each other");
  set_size(header, sizes, name);
  const std::string channels = value_of(entries, {"elementnumberofchannels"});
  if (!channels.empty() && channels != "1")
    throw Unsupported(name + ": has " + cited(channels) + " numbers per voxel; give an image of one");
  if (value_of(entries, {"binarydata"}) == "false")
    throw Unsupported(name + ": voxels as text are not supported; store them as binary");
  header.type = number_type(value_of(entries, {"elementtype"}), name);
  set_data(header, entries, header_end, name);
  header.big_endian = is_true(value_of(entries, {"binarydatabyteordermsb", "elementbyteordermsb"}));
  set_place(header, entries, name);
  return header;
}

}  // namespace vmesh::image

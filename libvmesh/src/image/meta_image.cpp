// MetaImage (https://itk.org/Wiki/ITK/MetaIO/Documentation), header and voxels in one file. Its frame is LPS.
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

/// The lines up to ElementDataFile, the last one; keys and values in lower case.
Entries entries_of(std::string_view bytes, const std::string& name, std::uint64_t& data_begin) {
  Entries entries;
  std::string_view rest = bytes, line;
  while (take_line(rest, line)) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) break;
    const std::string key = folded(line.substr(0, equals));
    entries[key] = folded(line.substr(equals + 1));
    if (key != "elementdatafile") continue;
    data_begin = bytes.size() - rest.size();
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
  const Entries entries = entries_of(bytes, name, header.data_begin);
  if (value_of(entries, {"elementdatafile"}) != "local")
    throw Unsupported(name + ": its voxels are in another file; store header and voxels in one");
  const std::vector<double> sizes = numbers_in(value_of(entries, {"dimsize"}), name, "DimSize");
  const std::vector<double> dimensions = numbers_in(value_of(entries, {"ndims"}), name, "NDims");
  if (dimensions.size() != 1 || dimensions[0] != static_cast<double>(sizes.size()))
    throw InvalidInput(name + ": the header's NDims and DimSize contradict each other");
  set_size(header, sizes, name);
  const std::string channels = value_of(entries, {"elementnumberofchannels"});
  if (!channels.empty() && channels != "1")
    throw Unsupported(name + ": has " + cited(channels) + " numbers per voxel; give an image of one");
  const std::string skipped = value_of(entries, {"headersize"});
  if (!skipped.empty() && skipped != "0")
    throw Unsupported(name + ": HeaderSize is not supported; store the image anew");
  if (value_of(entries, {"binarydata"}) == "false")
    throw Unsupported(name + ": voxels as text are not supported; store them as binary");
  header.type = number_type(value_of(entries, {"elementtype"}), name);
  header.packed = is_true(value_of(entries, {"compresseddata"}));
  header.big_endian = is_true(value_of(entries, {"binarydatabyteordermsb", "elementbyteordermsb"}));
  set_place(header, entries, name);
  return header;
}

}  // namespace vmesh::image

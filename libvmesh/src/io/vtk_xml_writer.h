// VTK's XML files (VTK File Formats, "XML File Formats"), written: arrays appended, packed by zlib. Internal to the
// module.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vmesh/core/file_format.h"

#include "bytes.h"

namespace vmesh::io {

/// One array as it follows the XML: the number of blocks, their size, that of the last if it is smaller, the sizes of
/// the packed blocks (all as 64-bit integers), and these.
class PackedArray {
 public:
  template <class T>
  void add(T value) {
    store(block_, value);
    if (block_.size() == kBlock) pack();
  }

  std::string bytes();

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 18;  // bytes that are packed together

  void pack();

  std::string block_, packed_;
  std::vector<std::uint64_t> sizes_;
};

/// Text as it is in an attribute.
std::string vtk_escaped(std::string_view text);

/// The XML, in the order in which it is built, and the arrays that follow it.
class VtkXmlFile {
 public:
  /// `kind`: PolyData or UnstructuredGrid.
  explicit VtkXmlFile(std::string kind) : kind_(std::move(kind)) { open(kind_); }

  void open(const std::string& tag) {
    xml_ += std::string(2 * tags_.size(), ' ') + "<" + tag + ">\n", tags_.push_back(tag);
  }
  void close() {
    const std::string name = tags_.back().substr(0, tags_.back().find(' '));
    tags_.pop_back();
    xml_ += std::string(2 * tags_.size(), ' ') + "</" + name + ">\n";
  }

  /// `values`: called with a function that takes the numbers, which are of type T.
  template <class T, class Values>
  void add_array(const char* type, const std::string& name, int components, std::size_t tuples, Values&& values) {
    PackedArray array;
    values([&](auto value) { array.add(static_cast<T>(value)); });
    xml_ += std::string(2 * tags_.size(), ' ') + "<DataArray type=\"" + type + "\" Name=\"" + vtk_escaped(name) + "\"";
    if (components != 1) xml_ += " NumberOfComponents=\"" + std::to_string(components) + "\"";
    if (tags_.back() == "FieldData") xml_ += " NumberOfTuples=\"" + std::to_string(tuples) + "\"";
    xml_ += " format=\"appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
    appended_ += array.bytes();
  }

  void add_numbers(const std::string& name, const std::vector<double>& values, bool integer, int components = 1) {
    const auto all = [&](const auto& take) {
      for (const double value : values) take(value);
    };
    const std::size_t tuples = values.size() / static_cast<std::size_t>(components);
    if (integer) {
      add_array<std::int32_t>("Int32", name, components, tuples, all);
    } else {
      add_array<double>("Float64", name, components, tuples, all);
    }
  }

  /// Left out if it is empty.
  void add_text(const char* name, const std::string& text) {
    if (!text.empty()) add_texts(name, {text});
  }

  /// Codes of the bytes of each, and a zero.
  void add_texts(const char* name, const std::vector<std::string>& texts);

  /// `element`: Verts, Lines or Polys. `corners`: called with a function that takes the numbers of points,
  /// `to_a_cell` for each cell.
  template <class Corners>
  void add_cells(const char* element, std::size_t cells, std::size_t to_a_cell, Corners&& corners) {
    open(element);
    add_array<std::int64_t>("Int64", "connectivity", 1, cells, corners);
    add_array<std::int64_t>("Int64", "offsets", 1, cells, [&](const auto& take) {
      for (std::size_t c = 1; c <= cells; ++c) take(c * to_a_cell);
    });
    close();
  }

  template <class Position>
  void add_points(std::size_t count, const Position& position) {
    open("Points");
    add_array<double>("Float64", "Points", 3, count, [&](const auto& take) {
      for (std::size_t i = 0; i < count; ++i)
        for (const double x : position(i)) take(x);
    });
    close();
  }

  /// Closes the elements that are open.
  void write(std::ostream& out);

 private:
  std::string kind_;
  std::vector<std::string> tags_;  // open
  std::string xml_, appended_;
};

template <class Metadata>
void add_metadata(VtkXmlFile& file, const Metadata& metadata) {
  file.add_text("SPACE", std::string(to_string(metadata.space)));
  file.add_text("UNIT", std::string(to_string(metadata.unit)));
  file.add_text("Generator", metadata.generator);
  file.add_text("Options", metadata.options);
  file.add_text("Input", metadata.input_name);
  file.add_text("InputSHA256", metadata.input_sha256);
}

}  // namespace vmesh::io

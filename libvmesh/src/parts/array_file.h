#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "vmesh/core/types.h"

namespace vmesh {

/// A file of named arrays of numbers after a JSON header: "vmesh arrays 1\n", the header's size in eight bytes, the
/// header, the arrays, little-endian. The header lists name, type, count and offset (from its own end) of each array,
/// and contains a checksum (CRC-32) of everything, itself included.
class ArrayWriter {
 public:
  explicit ArrayWriter(nlohmann::json header) : header_(std::move(header)) {}

  /// Keeps a reference to the numbers, which must live until they are written.
  void add(const std::string& name, std::span<const double> numbers) { add(name, "f8", std::as_bytes(numbers), 8); }
  void add(const std::string& name, std::span<const Index> numbers) { add(name, "u4", std::as_bytes(numbers), 4); }
  void add(const std::string& name, std::span<const char> numbers) { add(name, "u1", std::as_bytes(numbers), 1); }
  /// Three numbers per point.
  void add(const std::string& name, const std::vector<Vec3>& points) {
    add(name, std::span(points.empty() ? nullptr : points.front().data(), 3 * points.size()));
  }

  /// The file appears complete or not at all. Throws WriteError.
  void write(const std::filesystem::path& path);

 private:
  void add(const std::string& name, const char* type, std::span<const std::byte> bytes, std::size_t size);

  nlohmann::json header_;
  nlohmann::json list_ = nlohmann::json::array();
  std::vector<std::span<const std::byte>> arrays_;
};

/// Reads such files. Throws ReadError (missing, unreadable) and InvalidInput, naming the file.
class ArrayFile {
 public:
  /// `schema`: what the header must say of itself.
  ArrayFile(const std::filesystem::path& path, const std::string& schema);

  const nlohmann::json& header() const { return header_; }
  const std::string& name() const { return name_; }

  std::size_t count(const std::string& array) const { return find(array).count; }
  void read(const std::string& array, std::vector<double>& numbers) { read_all(array, "f8", numbers); }
  void read(const std::string& array, std::vector<Index>& numbers) { read_all(array, "u4", numbers); }
  void read(const std::string& array, std::vector<char>& numbers) { read_all(array, "u1", numbers); }
  void read(const std::string& array, std::vector<Vec3>& points);
  /// Reads the whole file once. Throws InvalidInput if the checksum does not match.
  void verify();

  /// Throws InvalidInput, "NAME: WHAT".
  [[noreturn]] void refuse(const std::string& what) const;
  void require(bool holds, const std::string& what) const {
    if (!holds) refuse(what);
  }

 private:
  struct Array {
    std::string name, type;
    std::size_t count = 0, offset = 0;
  };

  const Array& find(const std::string& name) const;
  void read_bytes(std::size_t offset, std::span<std::byte> bytes);
  void read_array(const std::string& name, const char* type, std::size_t first, std::span<std::byte> bytes,
                  std::size_t size);
  template <class Number>
  void read_all(const std::string& array, const char* type, std::vector<Number>& numbers) {
    numbers.resize(count(array));
    read_array(array, type, 0, std::as_writable_bytes(std::span(numbers)), sizeof(Number));
  }

  std::string name_;
  std::ifstream file_;
  std::uint64_t size_ = 0, first_ = 0;  // of the file; where arrays begin
  nlohmann::json header_;
  std::vector<Array> arrays_;
};

}  // namespace vmesh

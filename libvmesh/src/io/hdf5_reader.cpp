// Vascular networks of MorphIO and VessMorphoVis: HDF5 files with `points` (x, y, z, diameter), `structure` (first
// point of every section, and its type) and `connectivity` (pairs of sections, the second begins where the first ends).
#include <cmath>
#include <vector>

#include <hdf5.h>

#include "vmesh/core/child_process.h"
#include "vmesh/core/disjoint_sets.h"
#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"

#include "bytes.h"
#include "formats.h"
#include "poly_lines.h"

namespace vmesh::io {
namespace {

constexpr double kBestRatio = 1032;  // largest compression ratio of zlib, which HDF5 uses

struct Table {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;

  double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

/// Owns an HDF5 handle and closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  bool good() const { return id_ >= 0; }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Used in a child process, as HDF5 may crash.
class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& path)
      : source_(path.string()),
        bytes_(std::filesystem::file_size(path)),
        file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {
    if (!file_.good()) throw InvalidInput(source_ + ": this is not an HDF5 file, or a damaged one");
  }

  bool has(const char* name) const { return H5Lexists(file_, name, H5P_DEFAULT) > 0; }

  /// A table with at least that many columns.
  Table table(const char* name, std::size_t columns) const {
    const auto fail = [&](const std::string& what) {
      throw InvalidInput(source_ + ": the data set \"" + name + "\" " + what);
    };
    if (!has(name)) fail("is missing; is this a vascular network of MorphIO?");
    const Handle data(H5Dopen2(file_, name, H5P_DEFAULT), H5Dclose);
    if (!data.good()) fail("cannot be read");
    const Handle space(H5Dget_space(data), H5Sclose);
    hsize_t size[2] = {0, 0};
    if (!space.good() || H5Sget_simple_extent_ndims(space) != 2 ||
        H5Sget_simple_extent_dims(space, size, nullptr) != 2 || size[1] < columns)
      fail("is not a table of " + std::to_string(columns) + " columns");
    const double most = kBestRatio * static_cast<double>(bytes_);
    if (static_cast<double>(size[0]) * static_cast<double>(size[1]) > most)
      fail("is larger than the file can hold; the file is damaged, get it again");
    Table table{static_cast<std::size_t>(size[0]), static_cast<std::size_t>(size[1]), {}};
    table.values.resize(table.rows * table.columns);
    if (H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, table.values.data()) < 0)
      fail("cannot be read");
    return table;
  }

 private:
  std::string source_;
  std::uintmax_t bytes_;  ///< of the file
  Handle file_;
};

void store(std::string& bytes, const Table& table) {
  io::store(bytes, static_cast<std::uint64_t>(table.rows));
  io::store(bytes, static_cast<std::uint64_t>(table.columns));
  for (const double value : table.values) io::store(bytes, value);
}

std::string tables_in(const std::filesystem::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // no messages of its own
  const Hdf5File file(path);
  std::string bytes;
  store(bytes, file.table("points", 4));
  store(bytes, file.table("structure", 1));
  store(bytes, file.has("connectivity") ? file.table("connectivity", 2) : Table{0, 2, {}});
  return bytes;
}

Table take_table(const std::string& bytes, std::size_t& at) {
  const auto number = [&] {
    at += sizeof(std::uint64_t);
    return static_cast<std::size_t>(load<std::uint64_t>(bytes.data() + at - sizeof(std::uint64_t)));
  };
  Table table{number(), number(), {}};
  table.values.reserve(table.rows * table.columns);
  for (std::size_t i = 0; i < table.rows * table.columns; ++i, at += sizeof(double))
    table.values.push_back(load<double>(bytes.data() + at));
  return table;
}

class Network {
 public:
  Network(std::string source, Table points, Table structure, Table connectivity)
      : source_(std::move(source)),
        points_(std::move(points)),
        structure_(std::move(structure)),
        connectivity_(std::move(connectivity)) {}

  RawCenterline run() {
    PolyLines lines;
    for (std::size_t c = 0; c < structure_.rows; ++c) lines.lines.push_back(section(c));
    DisjointSets same(points_.rows);
    for (std::size_t c = 0; c < connectivity_.rows; ++c) connect(c, same, lines.lines);
    std::vector<double> radii;
    std::vector<Index> number(points_.rows, kNone);
    for (Index i = 0; i < points_.rows; ++i) {
      if (same.find(i) != i) continue;
      number[i] = static_cast<Index>(lines.points.size());
      lines.points.push_back({position(i), 0});
      radii.push_back(points_.at(i, 3) / 2);
    }
    for (std::vector<Index>& line : lines.lines) {
      for (Index& i : line) i = number[same.find(i)];
    }
    const ScalarArrays of_points = {{"radius", std::move(radii)}}, none;
    RawCenterline raw = to_raw_centerline(std::move(lines), source_, {of_points, none}, {});
    raw.unit = LengthUnit::um;
    return raw;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(source_ + ": " + what); }

  std::size_t index(double value, std::size_t count, const std::string& what) const {
    if (!(value >= 0 && value < static_cast<double>(count)) || value != std::floor(value))
      fail(what + " does not exist; there are " + std::to_string(count));
    return static_cast<std::size_t>(value);
  }

  std::size_t first_point(std::size_t s) const {
    if (s == structure_.rows) return points_.rows;
    return index(structure_.at(s, 0), points_.rows, "the first point of section " + std::to_string(s));
  }

  std::vector<Index> section(std::size_t s) const {
    const std::size_t begin = first_point(s), end = first_point(s + 1);
    if (begin >= end) fail("section " + std::to_string(s) + " has no points, or sections are not in order");
    std::vector<Index> line;
    for (std::size_t i = begin; i < end; ++i) line.push_back(static_cast<Index>(i));
    return line;
  }

  Vec3 position(std::size_t i) const { return {points_.at(i, 0), points_.at(i, 1), points_.at(i, 2)}; }

  /// Connects the end of the first section to the beginning of the second: the same point, or a segment between two.
  void connect(std::size_t c, DisjointSets& same, std::vector<std::vector<Index>>& lines) const {
    const std::string what = "section of connection " + std::to_string(c);
    const std::size_t first = index(connectivity_.at(c, 0), structure_.rows, "the first " + what);
    const std::size_t second = index(connectivity_.at(c, 1), structure_.rows, "the second " + what);
    const Index end = lines[first].back(), begin = lines[second].front();
    if (position(end) == position(begin)) {
      same.join(end, begin);
    } else {
      lines.push_back({end, begin});
    }
  }

  std::string source_;
  Table points_, structure_, connectivity_;
};

}  // namespace

RawCenterline read_hdf5_network(const std::filesystem::path& path) {
  const std::size_t size = InputFile(path).size();
  const std::string bytes = in_child_process(path.string(), size, [&] { return tables_in(path); });
  std::size_t at = 0;
  Table points = take_table(bytes, at), structure = take_table(bytes, at), connectivity = take_table(bytes, at);
  return Network(path.string(), std::move(points), std::move(structure), std::move(connectivity)).run();
}

}  // namespace vmesh::io

// Networks of the Secomb group's programs (network.dat): blocks of rows after their counts.
#include <unordered_map>

#include "edge_radii.h"
#include "formats.h"
#include "text.h"

namespace vmesh::io {
namespace {

class NetworkReader {
 public:
  NetworkReader(std::string_view content, const std::string& source) : lines_(content) {
    raw_.source = source;
    raw_.node_word = raw_.segment_word = "line";
    raw_.unit = LengthUnit::um;
  }

  RawCenterline run() {
    next_line("the title");
    read_numbers(3, "the sides of the box");
    read_numbers(3, "the numbers of grid points");
    read_numbers(1, "the outer bound");
    read_numbers(1, "the longest segment");
    read_numbers(1, "the most segments at a node");
    read_segments();
    read_nodes();
    connect();
    return std::move(raw_);
  }

 private:
  struct Segment {
    std::int64_t from, to;
    double diameter;
    std::uint64_t line;
  };

  [[noreturn]] void fail(std::uint64_t line, const std::string& what) const {
    throw InvalidInput(raw_.source + ": line " + std::to_string(line) + ": " + what);
  }
  [[noreturn]] void fail(const std::string& what) const { fail(lines_.number(), what); }

  /// The next line that is not blank, split.
  void next_line(const std::string& wanted) {
    std::string_view line;
    do {
      if (!lines_.next(line))
        fail("the file ends where " + wanted + " should be; this is not a network.dat, or it is cut off");
      split_blank(line, fields_);
    } while (fields_.empty());
  }

  /// Reads a line that begins with `count` numbers, followed by their meaning.
  void read_numbers(std::size_t count, const std::string& wanted) {
    next_line(wanted);
    for (std::size_t i = 0; i < count; ++i) real(i, wanted);
  }

  std::size_t read_count(const std::string& wanted) {
    next_line(wanted);
    const std::int64_t value = integer(0, wanted);
    if (value < 0) fail(wanted + " is negative");
    return static_cast<std::size_t>(value);
  }

  /// Reads a count, a header line, and as many rows of at least `columns` fields; each is passed to `keep`.
  template <typename Keep>
  void read_rows(const std::string& plural, const std::string& row, std::size_t columns, Keep keep) {
    const std::size_t count = read_count("the number of " + plural);
    next_line("the head of the " + plural);
    for (std::size_t i = 0; i < count; ++i) {
      next_line("a row of the " + plural);
      if (fields_.size() < columns) fail("a row of the " + plural + " is: " + row);
      keep();
    }
  }

  void read_segments() {
    read_rows("segments", "name, type, from, to, diameter, flow, hematocrit", 5, [&] {
      segments_.push_back({integer(2, "the node"), integer(3, "the node"), real(4, "the diameter"), lines_.number()});
    });
  }

  void read_nodes() {
    read_rows("nodes", "name, x, y, z", 4, [&] {
      const std::int64_t name = integer(0, "the name");
      if (!node_of_.try_emplace(name, static_cast<Index>(raw_.nodes.size())).second)
        fail("the node " + std::to_string(name) + " occurs twice");
      raw_.nodes.push_back({{real(1, "x"), real(2, "y"), real(3, "z")}, 0});
      raw_.node_numbers.push_back(lines_.number());
    });
  }

  void connect() {
    std::vector<double> radii;
    for (const Segment& segment : segments_) {
      const Index from = node(segment.from, segment.line);
      raw_.segments.push_back({from, node(segment.to, segment.line)});
      raw_.segment_numbers.push_back(segment.line);
      radii.push_back(segment.diameter / 2);
    }
    if (raw_.segments.empty()) fail("it contains no segment");
    set_radii_of_segments(raw_, radii);
  }

  Index node(std::int64_t name, std::uint64_t line) const {
    const auto found = node_of_.find(name);
    if (found == node_of_.end()) fail(line, "there is no node " + std::to_string(name));
    return found->second;
  }

  double real(std::size_t column, const std::string& what) const {
    const std::string_view field = column < fields_.size() ? fields_[column] : std::string_view();
    const auto value = parse_double(field);
    if (!value) fail(cite(field) + " is not a number; " + what + " should be here");
    return *value;
  }

  std::int64_t integer(std::size_t column, const std::string& what) const {
    const std::string_view field = column < fields_.size() ? fields_[column] : std::string_view();
    const auto value = parse_integer(field);
    if (!value) fail(cite(field) + " is not an integer; " + what + " should be here");
    return *value;
  }

  LineReader lines_;
  RawCenterline raw_;
  std::vector<std::string_view> fields_;
  std::vector<Segment> segments_;
  std::unordered_map<std::int64_t, Index> node_of_;
};

}  // namespace

RawCenterline parse_network(std::string_view content, const std::string& source, const CenterlineReadOptions&) {
  return NetworkReader(content, source).run();
}

}  // namespace vmesh::io

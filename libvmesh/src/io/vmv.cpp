#include <optional>
#include <unordered_map>

#include "formats.h"
#include "text.h"

namespace vmesh::io {
namespace {

constexpr std::string_view kParameters = "param", kVertices = "vert_list", kStrands = "strands_list";

/// Sections run from `$NAME_BEGIN` to `$NAME_END`; the order in the file does not matter.
class VmvReader {
 public:
  VmvReader(std::string_view content, const std::string& source) : lines_(content) {
    raw_.source = source;
    raw_.node_word = raw_.segment_word = "line";
  }

  RawCenterline run() {
    std::string_view line;
    while (lines_.next(line)) read_line(line);
    check_complete();
    for (const Strand& strand : strands_) connect(strand);
    if (raw_.segments.empty()) {
      fail(line_of_section_.at(std::string(kStrands)),
           "there is no strand of two vertices or more; a centerline is made of strands `id vertex vertex ...`");
    }
    note();
    return std::move(raw_);
  }

 private:
  struct Section {
    std::string name;  ///< lower case, without $ and _begin
    std::uint64_t line;
  };
  struct Count {
    std::size_t value;
    std::uint64_t line;
  };
  struct Vertex {
    CenterlineNode content;
    std::uint64_t line;
    Index node = kNone;             ///< in raw_, once a strand uses it
    std::uint64_t strand_line = 0;  ///< of that strand
  };
  struct Strand {
    std::size_t begin, end;  ///< of its vertices in strand_vertices_
    std::uint64_t line;
  };

  [[noreturn]] void fail(std::uint64_t line, const std::string& what) const {
    throw InvalidInput(raw_.source + ": line " + std::to_string(line) + ": " + what);
  }
  [[noreturn]] void fail(const std::string& what) const { fail(lines_.number(), what); }

  void read_line(std::string_view line) {
    const std::size_t hash = line.find('#');
    if (hash != std::string_view::npos) {
      read_tags(line.substr(hash + 1), raw_.unit, raw_.space);
      line = line.substr(0, hash);
    }
    split_blank(line, fields_);
    if (fields_.empty()) return;
    const std::string word = lower(fields_[0]);
    if (word.starts_with('$') && word.ends_with("_begin")) return begin_section(word.substr(1, word.size() - 7));
    if (word.starts_with('$') && word.ends_with("_end")) return end_section(word.substr(1, word.size() - 5));
    if (!open_) fail(cite(fields_[0]) + " is outside of every section; sections run from $..._BEGIN to $..._END");
    if (open_->name == kParameters) read_parameter(word);
    if (open_->name == kVertices) read_vertex();
    if (open_->name == kStrands) read_strand();
  }

  void begin_section(const std::string& name) {
    if (open_) {
      fail(cite(fields_[0]) + " comes before the end of the section that begins in line " +
           std::to_string(open_->line) + "; that section is cut off or its $..._END is missing");
    }
    const auto [place, is_new] = line_of_section_.try_emplace(name, lines_.number());
    if (!is_new) fail("this section occurs twice, first in line " + std::to_string(place->second) + "; remove one");
    open_ = {name, lines_.number()};
    if (name != kParameters && name != kVertices && name != kStrands) {
      raw_.warnings.push_back(raw_.source + ": line " + std::to_string(lines_.number()) + ": the section " +
                              cite(fields_[0]) + " was ignored");
    }
  }

  void end_section(const std::string& name) {
    if (!open_ || open_->name != name) fail(cite(fields_[0]) + " ends a section that is not open; remove it");
    open_.reset();
  }

  void read_parameter(std::string_view key) {
    if (key.starts_with('$')) key.remove_prefix(1);
    for (const auto& [name, count] : {std::pair{"num_verts", &vertex_count_}, std::pair{"num_strands", &strand_count_},
                                      std::pair{"num_attrib_per_vert", &attribute_count_}}) {
      if (key != name) continue;
      const auto value = parse_integer(fields_.size() == 2 ? fields_[1] : std::string_view());
      if (!value || *value < 0) fail(cite(fields_[0]) + " must be followed by one count");
      *count = {static_cast<std::size_t>(*value), lines_.number()};
    }
  }

  void read_vertex() {
    constexpr std::size_t kColumns = 5;
    if (fields_.size() < kColumns) {
      fail("it has " + std::to_string(fields_.size()) + " columns; a vertex has five: id x y z radius");
    }
    if (fields_.size() > kColumns) ++rows_with_more_;
    const std::int64_t id = integer(fields_[0], "vertex id");
    const auto [place, is_new] = index_of_.try_emplace(id, vertices_.size());
    if (!is_new) {
      fail("the vertex id " + std::to_string(id) + " was given before, in line " +
           std::to_string(vertices_[place->second].line) + "; ids must be unique");
    }
    vertices_.push_back({{{real(1, "x"), real(2, "y"), real(3, "z")}, real(4, "radius")}, lines_.number()});
  }

  void read_strand() {
    integer(fields_[0], "strand id");  // checked but not needed
    const std::size_t begin = strand_vertices_.size();
    for (std::size_t i = 1; i < fields_.size(); ++i) strand_vertices_.push_back(integer(fields_[i], "vertex id"));
    strands_.push_back({begin, strand_vertices_.size(), lines_.number()});
  }

  std::int64_t integer(std::string_view field, const char* name) const {
    const auto value = parse_integer(field);
    if (!value) fail(std::string("the ") + name + " " + cite(field) + " is not an integer");
    return *value;
  }

  double real(std::size_t column, const char* name) const {
    const auto value = parse_double(fields_[column]);
    if (!value) fail(std::string("the ") + name + " " + cite(fields_[column]) + " is not a number");
    return *value;
  }

  void check_complete() const {
    if (open_) {
      fail("the file ends inside the section that begins in line " + std::to_string(open_->line) +
           "; it is cut off, get the whole file");
    }
    for (const auto& [name, shown] : {std::pair{kVertices, "$VERT_LIST_BEGIN"}, {kStrands, "$STRANDS_LIST_BEGIN"}}) {
      if (!line_of_section_.contains(std::string(name))) {
        fail(std::string("the file ends without a section ") + shown +
             "; a VMV file has vertices `id x y z radius` and strands `id vertex vertex ...`");
      }
    }
    check_count(vertex_count_, vertices_.size(), "vertices");
    check_count(strand_count_, strands_.size(), "strands");
    if (attribute_count_ && attribute_count_->value < 4) {
      fail(attribute_count_->line, "there must be at least four attributes per vertex: x y z radius");
    }
  }

  void check_count(const std::optional<Count>& promised, std::size_t present, const char* what) const {
    if (!promised || promised->value == present) return;
    fail(promised->line, std::to_string(promised->value) + " " + what + " are promised and " + std::to_string(present) +
                             " are there; add what is missing, or correct the number if nothing is");
  }

  void connect(const Strand& strand) {
    const bool is_line = strand.end - strand.begin >= 2;
    if (is_line) raw_.path_starts.push_back(static_cast<Index>(raw_.segments.size()));
    if (!is_line) ++short_strands_;
    Index before = kNone;
    for (std::size_t i = strand.begin; i < strand.end; ++i) {
      Vertex& vertex = vertex_of(strand_vertices_[i], strand.line);
      if (!is_line) continue;
      const Index node = node_of(vertex, strand.line);
      if (before != kNone) {
        raw_.segments.push_back({before, node});
        raw_.segment_numbers.push_back(strand.line);
      }
      before = node;
    }
  }

  Vertex& vertex_of(std::int64_t id, std::uint64_t line) {
    const auto found = index_of_.find(id);
    if (found == index_of_.end()) {
      fail(line, "there is no vertex " + std::to_string(id) + "; add it to the vertices or take it out of the strand");
    }
    return vertices_[found->second];
  }

  Index node_of(Vertex& vertex, std::uint64_t strand_line) {
    if (vertex.node == kNone) {
      vertex.node = static_cast<Index>(raw_.nodes.size());
      vertex.strand_line = strand_line;
      raw_.nodes.push_back(vertex.content);
      raw_.node_numbers.push_back(vertex.line);
    }
    if (vertex.strand_line != strand_line) strands_share_vertices_ = true;
    return vertex.node;
  }

  void note() {
    warn(rows_with_more_, "vertices have more columns than id x y z radius; the rest was ignored");
    warn(short_strands_, "strands have fewer than two vertices; left out");
    warn(vertices_.size() - raw_.nodes.size(), "vertices belong to no strand; left out");
    if (raw_.path_starts.size() > 1 && !strands_share_vertices_) {
      raw_.warnings.push_back(raw_.source + ": no vertex is in two strands, so the file does not say where the " +
                              std::to_string(raw_.path_starts.size()) +
                              " strands join; they are joined where their points coincide");
    }
  }

  void warn(std::size_t count, const char* what) {
    if (count > 0) raw_.warnings.push_back(raw_.source + ": " + std::to_string(count) + " " + what);
  }

  LineReader lines_;
  RawCenterline raw_;
  std::vector<std::string_view> fields_;
  std::optional<Section> open_;
  std::unordered_map<std::string, std::uint64_t> line_of_section_;
  std::optional<Count> vertex_count_, strand_count_, attribute_count_;
  std::vector<Vertex> vertices_;
  std::unordered_map<std::int64_t, std::size_t> index_of_;  ///< in vertices_, by id
  std::vector<Strand> strands_;
  std::vector<std::int64_t> strand_vertices_;
  std::size_t rows_with_more_ = 0, short_strands_ = 0;
  bool strands_share_vertices_ = false;
};

}  // namespace

RawCenterline parse_vmv(std::string_view content, const std::string& source, const CenterlineReadOptions&) {
  return VmvReader(content, source).run();
}

}  // namespace vmesh::io

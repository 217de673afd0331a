#include <algorithm>
#include <ostream>
#include <unordered_map>

#include "comments.h"
#include "formats.h"
#include "node_id.h"
#include "text.h"

namespace vmesh::io {
namespace {

constexpr std::string_view kNoParent = "-1";

class SwcReader {
 public:
  SwcReader(std::string_view content, const std::string& source, const CenterlineReadOptions& options)
      : lines_(content), voxel_size_(options.voxel_size) {
    refuse_utf16(content, source);
    raw_.source = source;
    raw_.node_word = raw_.segment_word = "line";
    raw_.tree_only = true;
  }

  RawCenterline run() {
    std::string_view line;
    while (lines_.next(line)) read_line(line);
    if (raw_.nodes.empty()) {
      throw InvalidInput(raw_.source + ": it contains no sample; an SWC file has rows `id type x y z radius parent`");
    }
    connect();
    check_acyclic();
    note();
    scale();
    return std::move(raw_);
  }

 private:
  [[noreturn]] void fail(std::uint64_t line, const std::string& what) const {
    throw InvalidInput(raw_.source + ": line " + std::to_string(line) + ": " + what);
  }

  void read_line(std::string_view line) {
    const std::size_t hash = line.find('#');
    if (hash != std::string_view::npos) {
      read_tags(line.substr(hash + 1), raw_.unit, raw_.space);
      if (says_voxels(line.substr(hash + 1)) && !voxel_size_)
        fail(lines_.number(), "the numbers are in voxels; give the side of one with --voxel-size");
      line = line.substr(0, hash);
    }
    split_blank(line, fields_);
    if (fields_.empty()) return;
    if (fields_.size() < 7) {
      fail(lines_.number(),
           "it has " + std::to_string(fields_.size()) + " columns; an SWC row has seven: id type x y z radius parent");
    }
    if (fields_.size() > 7) ++rows_with_more_;
    read_row();
  }

  void read_row() {
    const std::uint64_t line = lines_.number();
    const std::string id = id_in(0, "id");
    if (id == kNoParent) fail(line, "the id -1 means \"no parent\"; give this sample another one");
    const Index index = static_cast<Index>(raw_.nodes.size());
    const auto [place, is_new] = index_of_.try_emplace(id, index);
    if (!is_new) {
      fail(line, "the id " + shown_id(id) + " was given before, in line " +
                     std::to_string(raw_.node_numbers[place->second]) + "; ids must be unique");
    }
    raw_.nodes.push_back({{real(2, "x"), real(3, "y"), real(4, "z")}, real(5, "radius")});
    raw_.node_numbers.push_back(line);
    parent_id_.push_back(id_in(6, "parent"));
  }

  std::string id_in(std::size_t column, const char* name) const {
    const auto value = parse_id(fields_[column]);
    if (!value) {
      fail(lines_.number(),
           std::string("the ") + name + " " + cite(fields_[column]) + " is not an id; ids are integers or names");
    }
    return *value;
  }

  double real(std::size_t column, const char* name) const {
    const auto value = parse_double(fields_[column]);
    if (!value) fail(lines_.number(), std::string("the ") + name + " " + cite(fields_[column]) + " is not a number");
    return *value;
  }

  void connect() {
    parent_.assign(raw_.nodes.size(), kNone);
    for (Index n = 0; n < raw_.nodes.size(); ++n) {
      if (parent_id_[n] == kNoParent) continue;
      const auto found = index_of_.find(parent_id_[n]);
      if (found == index_of_.end()) {
        count_root(n);
        continue;
      }
      parent_[n] = found->second;
      raw_.segments.push_back({parent_[n], n});
      raw_.segment_numbers.push_back(raw_.node_numbers[n]);
    }
  }

  /// Of a sample whose parent is not in the file.
  void count_root(Index n) {
    const std::string& parent = parent_id_[n];
    if (parent == "0") {
      ++roots_of_0_;
    } else if (parent.starts_with('-') && parse_double(parent)) {
      ++odd_roots_;
    } else {
      fail(raw_.node_numbers[n], "its parent " + shown_id(parent) +
                                     " is not in the file; add that sample or make this one a root (parent -1)");
    }
  }

  void check_acyclic() const {
    std::vector<Index> visit(parent_.size(), kNone);  // the sample from which a walk to the root passed
    for (Index n = 0; n < parent_.size(); ++n) {
      Index m = n;
      while (m != kNone && visit[m] == kNone) {
        visit[m] = n;
        m = parent_[m];
      }
      if (m != kNone && visit[m] == n) {
        fail(raw_.node_numbers[m],
             "this sample is its own ancestor: following the parents from it leads back to it; "
             "give one sample of the loop the parent -1");
      }
    }
  }

  void note() {
    if (rows_with_more_ > 0) {
      raw_.warnings.push_back(raw_.source + ": " + std::to_string(rows_with_more_) +
                              " rows have more than seven columns; the rest was ignored");
    }
    if (roots_of_0_ > 0) {
      raw_.warnings.push_back(raw_.source + ": " + std::to_string(roots_of_0_) +
                              " samples have the parent 0, which is not in the file; taken as roots");
    }
    if (odd_roots_ > 0) {
      raw_.warnings.push_back(raw_.source + ": " + std::to_string(odd_roots_) +
                              " samples have a negative parent that is not in the file; taken as roots");
    }
  }

  /// From voxels to lengths.
  void scale() {
    if (!voxel_size_) return;
    const double side = voxel_size_->x();
    if (!(side > 0) || *voxel_size_ != Vec3::Constant(side)) {
      throw InvalidInput(raw_.source +
                         ": radii in voxels need voxels of equal sides, above 0; give one number with "
                         "--voxel-size, or convert the file to lengths first");
    }
    for (CenterlineNode& node : raw_.nodes) {
      node.position *= side;
      node.radius *= side;
    }
  }

  LineReader lines_;
  std::optional<Vec3> voxel_size_;
  RawCenterline raw_;
  std::vector<std::string_view> fields_;
  std::unordered_map<std::string, Index> index_of_;
  std::vector<std::string> parent_id_;
  std::vector<Index> parent_;
  std::size_t rows_with_more_ = 0, roots_of_0_ = 0, odd_roots_ = 0;
};

/// The parent of every node, away from the lowest node of its component.
std::vector<Index> parents_in_forest(const Centerline& centerline) {
  std::vector<Index> parent(centerline.nodes().size(), kNone), stack;
  std::vector<char> seen(parent.size(), 0);
  for (Index root = 0; root < parent.size(); ++root) {
    if (seen[root]) continue;
    seen[root] = 1;
    stack.push_back(root);
    while (!stack.empty()) {
      const Index n = stack.back();
      stack.pop_back();
      for (const Index s : centerline.incident_segments(n)) {
        const Index m = centerline.other_node(s, n);
        if (seen[m]) continue;
        seen[m] = 1;
        parent[m] = n;
        stack.push_back(m);
      }
    }
  }
  return parent;
}

}  // namespace

RawCenterline parse_swc(std::string_view content, const std::string& source, const CenterlineReadOptions& options) {
  return SwcReader(content, source, options).run();
}

void write_swc(std::ostream& out, const Centerline& centerline, const CenterlineMetadata& metadata,
               const std::vector<EndSection>&) {
  constexpr int kSoma = 1, kBranch = 3;
  const auto parent = parents_in_forest(centerline);
  out << comments(metadata, "# ") << "# id type x y z radius parent\n";
  std::string row;
  for (Index n = 0; n < parent.size(); ++n) {
    const auto& [p, r] = centerline.node(n);
    row = std::to_string(n + 1) + (parent[n] == kNone ? " " + std::to_string(kSoma) : " " + std::to_string(kBranch));
    for (const double x : {p.x(), p.y(), p.z(), r}) append(row += ' ', x);
    row += parent[n] == kNone ? " -1\n" : " " + std::to_string(parent[n] + 1) + "\n";
    out << row;
  }
}

}  // namespace vmesh::io

#include "end_section_arrays.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "text.h"

namespace vmesh::io {
namespace {

constexpr const char* kPrefix = "EndSection";
constexpr const char* kNode = "EndSectionNode";
constexpr const char* kCenter = "EndSectionCenter";
constexpr const char* kNormal = "EndSectionNormal";
constexpr const char* kArea = "EndSectionArea";
constexpr const char* kOpen = "EndSectionOpen";
constexpr const char* kRing = "EndSectionRing";
constexpr const char* kRingOffsets = "EndSectionRingOffsets";

void append(std::vector<double>& values, const Vec3& p) { values.insert(values.end(), p.begin(), p.end()); }

class SectionReader {
 public:
  SectionReader(const ScalarArrays& field, RawCenterline& raw) : field_(field), raw_(raw) {
    for (Index n = 0; n < raw.nodes.size(); ++n) node_of_point_.emplace(raw.node_numbers[n], n);
  }

  void run() {
    const std::vector<double>& points = all(kNode);
    const std::size_t count = points.size();
    const std::vector<double>&center = sized(kCenter, 3 * count), &normal = sized(kNormal, 3 * count);
    const std::vector<double>&area = sized(kArea, count), &open = sized(kOpen, count);
    const std::vector<double> begin = ring_begins(count);
    for (std::size_t i = 0; i < count; ++i) {
      EndSection section{node_at(points[i], i), vector_at(center, i), vector_at(normal, i), area[i], {}, open[i] != 0};
      for (auto p = static_cast<std::size_t>(begin[i]); p < static_cast<std::size_t>(begin[i + 1]); ++p)
        section.ring.push_back(vector_at(all(kRing), p));
      if (const std::string problem = problem_of(section); !problem.empty()) fail(i, problem);
      raw_.end_sections.push_back(std::move(section));
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(raw_.source + ": " + what); }
  [[noreturn]] void fail(std::size_t section, const std::string& what) const {
    fail("flat end " + std::to_string(section) + ": " + what);
  }

  /// Empty if there is none of that name.
  const std::vector<double>& all(const char* name) const {
    static const std::vector<double> kNothing;
    const auto found = field_.find(name);
    return found == field_.end() ? kNothing : found->second;
  }

  const std::vector<double>& sized(const char* name, std::size_t size) const {
    const std::vector<double>& values = all(name);
    if (values.size() != size)
      fail(std::string(name) + ": it holds " + std::to_string(values.size()) + " numbers, there should be " +
           std::to_string(size) + ", as " + kNode + " has " + std::to_string(all(kNode).size()));
    return values;
  }

  /// Numbers of points of the rings before each section's, and of all.
  std::vector<double> ring_begins(std::size_t count) const {
    if (all(kRingOffsets).empty() && all(kRing).empty()) return std::vector<double>(count + 1, 0);
    const std::vector<double>& begin = sized(kRingOffsets, count + 1);
    const bool whole = std::all_of(begin.begin(), begin.end(), [](double x) { return x == std::floor(x); });
    if (!whole || begin.front() != 0 || !std::is_sorted(begin.begin(), begin.end()) ||
        3 * begin.back() != static_cast<double>(all(kRing).size()))
      fail(std::string(kRingOffsets) + ": they must ascend from 0 to the number of points in " + kRing);
    return begin;
  }

  Index node_at(double point, std::size_t section) const {
    const bool is_number = point >= 0 && point < static_cast<double>(kNone) && point == std::floor(point);
    const auto found = is_number ? node_of_point_.find(static_cast<std::uint64_t>(point)) : node_of_point_.end();
    if (found != node_of_point_.end()) return found->second;
    std::string text;
    io::append(text, point);
    fail(section, "there is no point " + text + " with a line");
  }

  static Vec3 vector_at(const std::vector<double>& values, std::size_t i) {
    return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  }

  const ScalarArrays& field_;
  RawCenterline& raw_;
  std::unordered_map<std::uint64_t, Index> node_of_point_;
};

}  // namespace

std::vector<FieldArray> end_section_arrays(const std::vector<EndSection>& sections) {
  if (sections.empty()) return {};
  FieldArray node{kNode, 1, true, {}}, center{kCenter, 3, false, {}}, normal{kNormal, 3, false, {}};
  FieldArray area{kArea, 1, false, {}}, open{kOpen, 1, true, {}};
  FieldArray ring{kRing, 3, false, {}}, offsets{kRingOffsets, 1, true, {0}};
  for (const EndSection& section : sections) {
    node.values.push_back(section.node);
    append(center.values, section.center);
    append(normal.values, section.normal);
    area.values.push_back(section.area);
    open.values.push_back(section.open ? 1 : 0);
    for (const Vec3& p : section.ring) append(ring.values, p);
    offsets.values.push_back(static_cast<double>(ring.values.size() / 3));
  }
  return {node, center, normal, area, open, ring, offsets};
}

bool is_end_section_array(std::string_view name) { return name.starts_with(kPrefix); }

void read_end_sections(const ScalarArrays& field, RawCenterline& raw) {
  if (field.contains(kNode)) SectionReader(field, raw).run();
}

}  // namespace vmesh::io

// Scenes of tubes by ITK-TubeTK (MetaIO spatial objects, .tre): headers of "Key = Value", then points as text or
// floats.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <unordered_map>

#include <Eigen/Geometry>

#include "vmesh/core/stored_number.h"

#include "formats.h"
#include "text.h"

namespace vmesh::io {
namespace {

/// A tube, or another object whose children it places.
struct SceneObject {
  std::string type, id, parent;
  Eigen::Affine3d place = Eigen::Affine3d::Identity();  ///< in its parent; once placed, in the world
  Vec3 spacing = Vec3::Ones();                          ///< of the grid in which the file counts
  std::int64_t parent_point = -1;
  Index first_node = 0, nodes = 0;
};

/// What tells how the points of an object are stored.
constexpr std::array kOfPoints = {
    "NPoints",     "PointDim",      "BinaryData", "BinaryDataByteOrderMSB", "ElementByteOrderMSB",
    "ElementType", "CompressedData"};

class TubeSceneReader {
 public:
  TubeSceneReader(std::string_view content, const std::string& source, const CenterlineReadOptions& options)
      : lines_(content), options_(options) {
    raw_.source = source;
    raw_.node_word = "point";
    raw_.segment_word = "tube";
    raw_.loose_branches = true;
    raw_.unit = LengthUnit::mm;  // ITK's, as its frame
    raw_.space = Space::lps;
  }

  RawCenterline run() {
    std::string_view line;
    while (lines_.next(line)) read_line(trim(line));
    warn_of_missing_objects();
    place_objects();
    join_tubes();
    if (others_ > 0)
      raw_.warnings.push_back(raw_.source + ": " + std::to_string(others_) + " objects are no tubes; left out");
    if (raw_.segments.empty()) fail("it contains no tube of two points or more");
    return std::move(raw_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(raw_.source + ": " + what); }
  [[noreturn]] void fail_here(const std::string& what) const {
    fail("line " + std::to_string(lines_.number()) + ": " + what);
  }

  void read_line(std::string_view line) {
    if (line.empty()) return;
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) fail_here(cite(line) + " is no line such as \"NPoints = 5\"");
    const std::string key(trim(line.substr(0, equals)));
    const std::string_view value = trim(line.substr(equals + 1));
    if (key == "ObjectType") {
      objects_.emplace_back().type = lower(value);
      entries_.clear();
      return;
    }
    if (objects_.empty()) {
      if (key != "Comment") fail_here("this is not a scene of tubes: it does not begin with ObjectType");
      return;
    }
    if (key == "ID") objects_.back().id = value;
    if (key == "ParentID") objects_.back().parent = value;
    if (key == "ParentPoint") objects_.back().parent_point = parse_integer(value).value_or(-1);
    if (key == "ElementSpacing") objects_.back().spacing = vector<3>(key, value);
    if (key == "Offset" || key == "Position" || key == "Origin")
      objects_.back().place.translation() = vector<3>(key, value);
    if (key == "TransformMatrix" || key == "Rotation" || key == "Orientation") {
      const Eigen::Matrix<double, 9, 1> rows = vector<9>(key, value);
      objects_.back().place.linear() = rows.reshaped<Eigen::RowMajor>(3, 3);
      if (!(std::abs(objects_.back().place.linear().determinant()) > 0))
        fail_here(key + " makes all of it flat; its determinant must not be 0");
    }
    if (key == "NObjects" && objects_.size() == 1) announced_ = parse_integer(value).value_or(0);
    if (key == "NDims" && value != "3") fail_here("NDims is " + cite(value) + "; tubes in 3 dimensions are needed");
    if (key == "Points") return read_points();
    if (std::ranges::find(kOfPoints, key) != std::end(kOfPoints)) entries_[key] = value;
  }

  template <int Count>
  Eigen::Matrix<double, Count, 1> vector(const std::string& key, std::string_view value) {
    split_blank(value, fields_);
    Eigen::Matrix<double, Count, 1> numbers;
    if (fields_.size() != Count) fail_here(key + " needs " + std::to_string(Count) + " numbers");
    for (int i = 0; i < Count; ++i) numbers[i] = number(fields_[static_cast<std::size_t>(i)]);
    return numbers;
  }

  double number(std::string_view text) const {
    const auto value = parse_double(text);
    if (!value) fail_here(cite(text) + " is not a number");
    return *value;
  }

  /// Where x, y, z and the radius are in the list of a point's numbers; its length if there is no radius.
  std::array<std::size_t, 4> columns() {
    split_blank(entries_["PointDim"], fields_);
    std::array<std::size_t, 4> columns = {fields_.size(), fields_.size(), fields_.size(), fields_.size()};
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      const std::string name = lower(fields_[f]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (name == std::string_view("xyz").substr(axis, 1)) columns[axis] = f;
      }
      if (name == "r" || name == "rad" || name == "radius" || name == "s") columns[3] = f;
    }
    for (std::size_t c = 0; c < (options_.radius ? 3 : 4); ++c) {
      if (columns[c] == fields_.size())
        fail_here("PointDim must name x, y, z and r; it is " + cite(entries_["PointDim"]) +
                  "; give one radius for all with --radius if there is none");
    }
    return columns;
  }

  void read_points() {
    const std::array<std::size_t, 4> column = columns();
    const std::size_t width = fields_.size();
    const auto count = parse_integer(entries_["NPoints"]);
    const bool binary = is_true("BinaryData");
    const bool swapped = is_true("BinaryDataByteOrderMSB") || is_true("ElementByteOrderMSB");
    if (binary && is_true("CompressedData")) fail_here("its points are compressed; store them uncompressed or as text");
    const std::string& element = entries_["ElementType"];
    if (binary && !element.empty() && element != "MET_FLOAT" && element != "MET_DOUBLE")
      fail_here("points of " + cite(element) + " are not supported; store them as text");
    const NumberType type = element == "MET_DOUBLE" ? NumberType::f64 : NumberType::f32;
    const std::size_t least = binary ? width * size_of(type) : 2 * width - 1;
    if (!count || *count < 0 || static_cast<std::uint64_t>(*count) > lines_.rest().size() / least + 1)
      fail_here("NPoints is " + cite(entries_["NPoints"]) + ", which the file cannot hold; it is cut off or broken");
    SceneObject& object = objects_.back();
    object.first_node = static_cast<Index>(raw_.nodes.size());
    object.nodes = static_cast<Index>(*count);
    std::vector<double> numbers(width + 1, 0);  // the last for a radius that is not there
    fields_.clear();
    field_ = 0;
    for (Index p = 0; p < object.nodes; ++p) {
      const std::span stored(numbers.data(), width);
      binary ? take_numbers(type, swapped, stored) : read_numbers(stored);
      raw_.nodes.push_back({{numbers[column[0]], numbers[column[1]], numbers[column[2]]}, numbers[column[3]]});
    }
    if (object.type.ends_with("tube")) return;
    raw_.nodes.resize(object.first_node);
    object.nodes = 0;
    ++others_;
  }

  void read_numbers(std::span<double> numbers) {
    for (double& value : numbers) {
      while (field_ == fields_.size()) {
        std::string_view line;
        if (!lines_.next(line)) fail_here("the file ends within the points of a tube; get the whole file");
        split_blank(line, fields_);
        field_ = 0;
      }
      value = number(fields_[field_++]);
    }
  }

  void take_numbers(NumberType type, bool swapped, std::span<double> numbers) {
    const std::size_t size = size_of(type);
    const std::string_view bytes = lines_.take(numbers.size() * size);
    if (bytes.size() < numbers.size() * size)
      fail_here("the file ends within the points of a tube; get the whole file");
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = number_at(bytes.data() + i * size, type, swapped);
  }

  bool is_true(const std::string& key) { return lower(entries_[key]).starts_with('t'); }

  /// The scene itself is not counted.
  void warn_of_missing_objects() {
    const auto there = static_cast<std::int64_t>(objects_.size()) - 1;
    if (announced_ > there)
      raw_.warnings.push_back(raw_.source + ": NObjects is " + std::to_string(announced_) + ", but only " +
                              std::to_string(there) + " are there; the file may be cut off");
  }

  /// The parent of every object; objects_.size() where there is none.
  std::vector<std::size_t> parents() const {
    std::unordered_map<std::string, std::size_t> by_id;
    for (std::size_t o = 0; o < objects_.size(); ++o) {
      if (!objects_[o].id.empty() && objects_[o].id != "-1") by_id.try_emplace(objects_[o].id, o);
    }
    std::vector<std::size_t> parents;
    for (const SceneObject& object : objects_) {
      const auto found = by_id.find(object.parent);
      parents.push_back(found == by_id.end() ? objects_.size() : found->second);
    }
    return parents;
  }

  /// Applies spacings, and the transformations of objects and of their parents; to radii, the mean of what these
  /// stretch.
  void place_objects() {
    parents_ = parents();
    enum class State { waiting, open, placed };
    std::vector<State> states(objects_.size(), State::waiting);
    for (std::size_t start = 0; start < objects_.size(); ++start) {
      std::vector<std::size_t> line;  // of ancestors that are not placed
      for (std::size_t o = start; o < objects_.size() && states[o] != State::placed; o = parents_[o]) {
        if (states[o] == State::open) fail("the object with the ID " + cite(objects_[o].id) + " is its own ancestor");
        states[o] = State::open;
        line.push_back(o);
      }
      for (; !line.empty(); line.pop_back()) {
        SceneObject& object = objects_[line.back()];
        const std::size_t parent = parents_[line.back()];
        if (parent < objects_.size()) object.place = objects_[parent].place * object.place;
        states[line.back()] = State::placed;
      }
    }
    for (const SceneObject& object : objects_) {
      const double scale = object.spacing.x() * std::cbrt(std::abs(object.place.linear().determinant()));
      for (Index n = object.first_node; n < object.first_node + object.nodes; ++n) {
        auto& [position, radius] = raw_.nodes[n];
        position = object.place * position.cwiseProduct(object.spacing);
        radius *= scale;
      }
    }
  }

  void join_tubes() {
    for (std::size_t o = 0; o < objects_.size(); ++o) {
      const SceneObject& tube = objects_[o];
      if (tube.nodes == 0) continue;
      raw_.path_starts.push_back(static_cast<Index>(raw_.segments.size()));
      const auto join = [&](Index a, Index b) {
        raw_.segments.push_back({a, b});
        raw_.segment_numbers.push_back(o);
      };
      if (parents_[o] < objects_.size() && tube.parent_point >= 0 && tube.parent_point < objects_[parents_[o]].nodes)
        join(objects_[parents_[o]].first_node + static_cast<Index>(tube.parent_point), tube.first_node);
      for (Index n = tube.first_node + 1; n < tube.first_node + tube.nodes; ++n) join(n - 1, n);
      if (raw_.path_starts.back() == raw_.segments.size()) raw_.path_starts.pop_back();
    }
  }

  LineReader lines_;
  const CenterlineReadOptions& options_;
  RawCenterline raw_;
  std::vector<SceneObject> objects_;
  std::vector<std::size_t> parents_;
  std::int64_t announced_ = 0;                  ///< objects in the scene
  std::size_t others_ = 0;                      ///< objects with points that are no tubes
  std::map<std::string, std::string> entries_;  ///< of the last object, those of kOfPoints
  std::vector<std::string_view> fields_;
  std::size_t field_ = 0;  ///< the next one of a line of numbers
};

}  // namespace

RawCenterline parse_tube_scene(std::string_view content, const std::string& source,
                               const CenterlineReadOptions& options) {
  return TubeSceneReader(content, source, options).run();
}

}  // namespace vmesh::io

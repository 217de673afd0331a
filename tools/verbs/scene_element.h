// Reading a scene: JSON whose errors name the file and the element.
#pragma once

#include <cmath>
#include <initializer_list>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "vmesh/core/error.h"

#include "report/json.h"
#include "verbs/course.h"

namespace vmesh::tool {

/// An element of the document and its name for messages: "drag[0].path".
class Element {
 public:
  Element(const Json& json, std::string name, const std::string& source)
      : json_(json), name_(std::move(name)), source_(source) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(source_ + ": " + (name_.empty() ? "" : name_ + ": ") + what);
  }

  /// Refuses members that are not listed, as a misspelt one would go unnoticed.
  void allow(std::initializer_list<const char*> known) const {
    if (!json_.is_object()) fail("it must be an object {...}");
    for (const auto& [key, value] : json_.items()) {
      std::string list;
      bool found = false;
      for (const char* name : known) {
        found = found || key == name;
        list += (list.empty() ? "" : ", ") + std::string(name);
      }
      if (!found) fail("\"" + key + "\" is not known; there are " + list);
    }
  }

  const std::string& name() const { return name_; }
  bool has(const char* key) const { return json_.contains(key); }

  Element member(const char* key) const {
    if (!has(key)) fail("\"" + std::string(key) + "\" is missing");
    return {json_[key], name_.empty() ? key : name_ + "." + key, source_};
  }

  std::vector<Element> items() const {
    if (!json_.is_array()) fail("it must be an array [...]");
    std::vector<Element> all;
    for (std::size_t i = 0; i < json_.size(); ++i)
      all.emplace_back(json_[i], name_ + "[" + std::to_string(i) + "]", source_);
    return all;
  }
  std::vector<Element> items(const char* key) const { return has(key) ? member(key).items() : std::vector<Element>(); }

  double number(double low, double high) const {
    if (!json_.is_number()) fail("it must be a number");
    const double value = json_.get<double>();
    if (!(value >= low && value <= high)) {
      std::ostringstream range;
      range << "it is " << value << "; it must be in [" << low << ", " << high << "]";
      fail(range.str());
    }
    return value;
  }

  /// Overwrites `value` if there is such a member.
  void take(const char* key, double low, double high, double& value) const {
    if (has(key)) value = member(key).number(low, high);
  }
  void take(const char* key, double low, double high, int& value) const {
    if (!has(key)) return;
    const double number = member(key).number(low, high);
    if (number != std::floor(number)) member(key).fail("it must be an integer");
    value = static_cast<int>(number);
  }

  bool is_array() const { return json_.is_array(); }

  bool boolean() const {
    if (!json_.is_boolean()) fail("it must be true or false");
    return json_.get<bool>();
  }

  std::string text() const {
    if (!json_.is_string()) fail("it must be a string");
    return json_.get<std::string>();
  }

  Index node(std::size_t nodes) const {
    const double value = number(0, static_cast<double>(nodes) - 1);
    if (value != std::floor(value)) fail("it must be an integer, the number of a node of the centerline");
    return static_cast<Index>(value);
  }

  std::vector<double> numbers(std::size_t count, const char* form) const {
    const std::vector<Element> all = items();
    if (all.size() != count) fail(std::string("it must be ") + form);
    std::vector<double> values;
    for (const Element& item : all) values.push_back(item.number(-1e12, 1e12));
    return values;
  }

 private:
  const Json& json_;
  std::string name_;
  const std::string& source_;
};

template <class Value, class Read>
Course<Value> read_course(const Element& element, Read&& read) {
  Course<Value> course;
  for (const Element& item : element.items()) {
    const auto [time, value] = read(item);
    if (!course.time_s.empty() && time <= course.time_s.back()) item.fail("times must ascend");
    course.time_s.push_back(time);
    course.value.push_back(value);
  }
  if (course.time_s.empty()) element.fail("it must have at least one point");
  return course;
}

inline Course<Vec3> vector_course(const Element& element) {
  return read_course<Vec3>(element, [](const Element& item) {
    const std::vector<double> v = item.numbers(4, "[time_s, x, y, z]");
    return std::pair(v[0], Vec3(v[1], v[2], v[3]));
  });
}

}  // namespace vmesh::tool

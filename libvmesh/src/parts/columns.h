// Columns of part files. What a file holds is described once, by a function that takes either of these classes.
#pragma once

#include <deque>
#include <tuple>

#include "parts/array_file.h"

namespace vmesh {

/// For lists of structs, `row` returns the numbers of an element, as std::tie() of them; their type is the first one's.
template <class T, class Row>
using NumberOf = std::decay_t<std::tuple_element_t<0, std::invoke_result_t<Row, T&>>>;

class ColumnWriter {
 public:
  explicit ColumnWriter(ArrayWriter& file) : file_(file) {}

  template <class Number>
  void column(const std::string& name, const std::vector<Number>& numbers) {
    file_.add(name, std::span<const Number>(numbers));
  }
  void column(const std::string& name, const std::vector<Vec3>& points) { file_.add(name, points); }
  template <class T, class Row>
  void rows(const std::string& name, const std::vector<T>& elements, Row row) {
    using Number = NumberOf<const T, Row>;
    std::vector<Number>& numbers = std::get<std::deque<std::vector<Number>>>(kept_).emplace_back();
    const auto append = [&](const auto&... members) { (numbers.push_back(static_cast<Number>(members)), ...); };
    for (const T& element : elements) std::apply(append, row(element));
    column(name, numbers);
  }

 private:
  ArrayWriter& file_;
  std::tuple<std::deque<std::vector<double>>, std::deque<std::vector<Index>>> kept_;  // until the file is written
};

class ColumnReader {
 public:
  explicit ColumnReader(ArrayFile& file) : file_(file) {}

  void column(const std::string& name, auto& numbers) { file_.read(name, numbers); }
  template <class T, class Row>
  void rows(const std::string& name, std::vector<T>& elements, Row row) {
    std::vector<NumberOf<T, Row>> numbers;
    column(name, numbers);
    elements.resize(numbers.size() / std::tuple_size_v<std::invoke_result_t<Row, T&>>);
    auto next = numbers.begin();
    const auto set = [&](auto&... members) {
      ((members = static_cast<std::decay_t<decltype(members)>>(*next++)), ...);
    };
    for (T& element : elements) std::apply(set, row(element));
  }

 private:
  ArrayFile& file_;
};

/// The row of a struct of two numbers.
constexpr auto kBoth = [](auto& element) {
  auto& [first, second] = element;
  return std::tie(first, second);
};

}  // namespace vmesh

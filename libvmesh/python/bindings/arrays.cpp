#include "arrays.h"

#include "vmesh/core/error.h"

namespace vmesh::python {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(Index), "arrays are views of these");

std::string shape_of(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  return text + (array.ndim() == 1 ? ",)" : ")");
}

py::array as_array(const py::object& object, const std::string& name) {
  py::array array = py::array::ensure(object);
  if (!array) throw InvalidInput(name + ": not an array of numbers");
  return array;
}

bool is_empty(const py::array& array) { return array.size() == 0; }

// `columns` 0: one dimension.
void check_shape(const py::array& array, const std::string& name, const std::string& wanted, py::ssize_t columns) {
  const bool fits = columns == 0 ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == columns;
  if (!fits) throw InvalidInput(name + ": the shape is " + shape_of(array) + "; " + wanted + " is needed");
}

py::array_t<double, py::array::c_style | py::array::forcecast> as_doubles(const py::array& array,
                                                                          const std::string& name) {
  if (const char kind = array.dtype().kind(); kind != 'f' && kind != 'i' && kind != 'u')
    throw InvalidInput(name + ": not numbers, but of dtype " + py::str(array.dtype()).cast<std::string>());
  return py::array_t<double, py::array::c_style | py::array::forcecast>(array);
}

// Integers only: 1.7 is not a node.
py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> as_integers(const py::array& array,
                                                                                 const std::string& name) {
  if (const char kind = array.dtype().kind(); !is_empty(array) && kind != 'i' && kind != 'u')
    throw InvalidInput(name + ": integers are needed, these are of dtype " +
                       py::str(array.dtype()).cast<std::string>());
  return py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>(array);
}

Index to_index(std::int64_t value, const std::string& name, std::size_t row) {
  if (value < 0 || value >= kNone)
    throw InvalidInput(name + ": row " + std::to_string(row) + " has the index " + std::to_string(value) +
                       "; indices count from 0");
  return static_cast<Index>(value);
}

template <std::size_t columns>
std::vector<std::array<Index, columns>> to_rows(const py::object& object, const std::string& name,
                                                const std::string& wanted) {
  const py::array array = as_array(object, name);
  if (is_empty(array)) return {};
  check_shape(array, name, wanted, columns);
  const auto integers = as_integers(array, name);
  const auto* values = integers.data();
  std::vector<std::array<Index, columns>> rows(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < columns; ++k) rows[i][k] = to_index(*values++, name, i);
  }
  return rows;
}

}  // namespace

py::array points_view(const std::vector<Vec3>& points, const py::object& owner) {
  return view(points.empty() ? nullptr : points.data()->data(), {static_cast<py::ssize_t>(points.size()), 3},
              {sizeof(Vec3), sizeof(double)}, owner);
}

py::array triangles_view(const std::vector<Triangle>& faces, const py::object& owner) {
  return view(faces.empty() ? nullptr : faces.data()->data(), {static_cast<py::ssize_t>(faces.size()), 3},
              {sizeof(Triangle), sizeof(Index)}, owner);
}

py::array array_of(const Vec3& point) { return py::array_t<double>(3, point.data()); }

Vec3 to_point(const py::object& object, const std::string& name) {
  const std::vector<double> values = to_numbers(object, name, 3);
  return {values[0], values[1], values[2]};
}

std::vector<Vec3> to_points(const py::object& object, const std::string& name) {
  const py::array array = as_array(object, name);
  if (is_empty(array)) return {};
  check_shape(array, name, "(n, 3)", 3);
  const auto doubles = as_doubles(array, name);
  std::vector<Vec3> points(static_cast<std::size_t>(array.shape(0)));
  std::copy_n(doubles.data(), 3 * points.size(), points.data()->data());
  return points;
}

std::vector<double> to_numbers(const py::object& object, const std::string& name, std::size_t count) {
  const py::array array = as_array(object, name);
  if (array.ndim() != 1 || static_cast<std::size_t>(array.size()) != count)
    throw InvalidInput(name + ": the shape is " + shape_of(array) + "; (" + std::to_string(count) + ",) is needed");
  if (is_empty(array)) return {};
  const auto doubles = as_doubles(array, name);
  return {doubles.data(), doubles.data() + doubles.size()};
}

std::vector<std::array<Index, 2>> to_pairs(const py::object& object, const std::string& name) {
  return to_rows<2>(object, name, "(m, 2), the two nodes of every segment,");
}

std::vector<Triangle> to_triangles(const py::object& object, const std::string& name) {
  return to_rows<3>(object, name, "(m, 3), the three vertices of every face,");
}

std::vector<Index> to_indices(const py::object& object, const std::string& name) {
  const py::array array = as_array(object, name);
  if (is_empty(array)) return {};
  check_shape(array, name, "(m,)", 0);
  const auto integers = as_integers(array, name);
  std::vector<Index> result;
  for (py::ssize_t i = 0; i < integers.size(); ++i)
    result.push_back(to_index(integers.data()[i], name, static_cast<std::size_t>(i)));
  return result;
}

}  // namespace vmesh::python

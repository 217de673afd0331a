#pragma once

#include <optional>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::python {

namespace py = pybind11;

/// A read-only array over memory of `owner`, which it keeps alive.
template <class T>
py::array view(const T* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
               const py::object& owner) {
  // An array without memory of its own needs an address even if it is empty.
  static const T nothing{};
  py::array array(py::dtype::of<T>(), std::move(shape), std::move(strides), data != nullptr ? data : &nothing, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// One number per element of a vector of `Element`, with the elements' stride.
template <class T, class Element>
py::array member_view(const std::vector<Element>& elements, const T* first, const py::object& owner) {
  return view(elements.empty() ? nullptr : first, {static_cast<py::ssize_t>(elements.size())},
              {static_cast<py::ssize_t>(sizeof(Element))}, owner);
}

/// The values as they are, (n,).
template <class T>
py::array vector_view(const std::vector<T>& values, const py::object& owner) {
  return member_view(values, values.data(), owner);
}

py::array points_view(const std::vector<Vec3>& points, const py::object& owner);        ///< (n, 3) float64
py::array triangles_view(const std::vector<Triangle>& faces, const py::object& owner);  ///< (m, 3) uint32

/// An array that takes over the values without a copy.
template <class T>
py::array array_of(std::vector<T> values) {
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(static_cast<py::ssize_t>(kept->size()), kept->data(), owner);
}

py::array array_of(const Vec3& point);  ///< (3,), a copy

/// Conversions of arguments from Python, called `name` in messages. All copy, and throw InvalidInput describing a wrong
/// shape, type or element.
Vec3 to_point(const py::object& object, const std::string& name);
std::vector<Vec3> to_points(const py::object& object, const std::string& name);                        ///< (n, 3)
std::vector<double> to_numbers(const py::object& object, const std::string& name, std::size_t count);  ///< (count,)
std::vector<std::array<Index, 2>> to_pairs(const py::object& object, const std::string& name);         ///< (m, 2)
std::vector<Triangle> to_triangles(const py::object& object, const std::string& name);                 ///< (m, 3)
std::vector<Index> to_indices(const py::object& object, const std::string& name);                      ///< (m,)

/// None for kNone.
inline std::optional<Index> optional_index(Index i) {
  if (i == kNone) return std::nullopt;
  return i;
}

}  // namespace vmesh::python

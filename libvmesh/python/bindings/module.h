#pragma once

#include <pybind11/pybind11.h>

namespace vmesh::python {

namespace py = pybind11;

/// Each adds the functions and classes of its topic to the module.
void bind_errors();
void bind_centerline(py::module_& module);
void bind_surface(py::module_& module);
void bind_generation(py::module_& module);
void bind_fit(py::module_& module);
void bind_evaluation(py::module_& module);
void bind_images(py::module_& module);
void bind_pages(py::module_& module);
void bind_pictures(py::module_& module);
void bind_deformation(py::module_& module);
void bind_solid(py::module_& module);

}  // namespace vmesh::python

#include "module.h"

#include <string>

#include "vmesh/core/version.h"

PYBIND11_MODULE(_core, module) {
  using namespace vmesh::python;
  module.doc() = "The compiled part of vmesh. Use the package vmesh.";
  module.attr("__version__") = std::string(vmesh::version());
  // NumPy 2 lays out what describes an array anew: older pybind11 would take strides from a wrong place.
  module.attr("_knows_numpy_2") = PYBIND11_VERSION_HEX >= 0x020C0000;
  bind_errors();
  bind_centerline(module);
  bind_surface(module);
  bind_generation(module);
  bind_evaluation(module);
  bind_fit(module);
  bind_images(module);
  bind_pages(module);
  bind_pictures(module);
  bind_deformation(module);
  bind_solid(module);
}

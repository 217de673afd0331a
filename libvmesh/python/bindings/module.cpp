#include "module.h"

#include <string>

#include "vmesh/core/version.h"

PYBIND11_MODULE(_core, module) {
  using namespace vmesh::python;
  module.doc() = "The compiled part of vmesh. Use the package vmesh.";
  module.attr("__version__") = std::string(vmesh::version());
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

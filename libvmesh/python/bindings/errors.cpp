#include <pybind11/pybind11.h>

#include "vmesh/core/error.h"

#include "module.h"

namespace vmesh::python {
namespace {

void raise(const char* name, const Error& error) {
  const py::object type = py::module_::import("vmesh._errors").attr(name);
  PyErr_SetString(type.ptr(), error.what());
}

}  // namespace

void bind_errors() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    if (!thrown) return;
    try {
      std::rethrow_exception(thrown);
    } catch (const InvalidInput& error) {
      raise("InvalidInput", error);
    } catch (const ReadError& error) {
      raise("ReadError", error);
    } catch (const WriteError& error) {
      raise("WriteError", error);
    } catch (const Unsupported& error) {
      raise("Unsupported", error);
    } catch (const Cancelled& error) {
      raise("Cancelled", error);
    } catch (const Error& error) {
      raise("Error", error);
    }
  });
}

}  // namespace vmesh::python

#pragma once

#include <functional>
#include <optional>

#include <pybind11/pybind11.h>

#include "vmesh/core/progress.h"

namespace vmesh::python {

/// Runs `work` on a separate thread without the interpreter's lock, so that other Python threads continue. Meanwhile
/// this thread checks for signals and calls `callback(stage, fraction)`, unless it is None, up to 20 times a second. A
/// signal whose handler raises (Ctrl-C: KeyboardInterrupt), or a callback that raises or returns False, cancels the
/// work at its next progress report; the exception, or Cancelled, is thrown once the work has ended.
void run(const pybind11::object& callback, const std::function<void(const Progress&)>& work);

/// The same with a result.
template <class Work>
auto result_of(const pybind11::object& callback, const Work& work) {
  std::optional<decltype(work(Progress()))> result;
  run(callback, [&](const Progress& progress) { result.emplace(work(progress)); });
  return std::move(*result);
}

}  // namespace vmesh::python

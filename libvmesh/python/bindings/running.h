#pragma once

#include <functional>
#include <optional>

#include <pybind11/pybind11.h>

#include "vmesh/core/progress.h"

namespace vmesh::python {

/// Runs `work` on a thread of its own, without the interpreter's lock, so that other threads of Python go on. Meanwhile
/// this thread looks for signals and calls `callback(stage, fraction)`, unless it is None, up to 20 times a second.
/// A signal whose handler raises (Ctrl-C: KeyboardInterrupt), a callback that raises or one that returns False
/// cancels the work as soon as it reports progress; what was raised, or Cancelled, is thrown once it has ended.
void run(const pybind11::object& callback, const std::function<void(const Progress&)>& work);

/// The same with a result.
template <class Work>
auto result_of(const pybind11::object& callback, const Work& work) {
  std::optional<decltype(work(Progress()))> result;
  run(callback, [&](const Progress& progress) { result.emplace(work(progress)); });
  return std::move(*result);
}

}  // namespace vmesh::python

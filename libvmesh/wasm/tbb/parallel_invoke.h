#pragma once

namespace tbb {

template <class... Bodies>
void parallel_invoke(const Bodies&... bodies) {
  (bodies(), ...);
}

}  // namespace tbb

#pragma once

namespace tbb {

class task_arena {
 public:
  static constexpr int automatic = -1;
  explicit task_arena(int = automatic) {}
  template <class Body>
  auto execute(const Body& body) {
    return body();
  }
};

namespace this_task_arena {

template <class Body>
auto isolate(const Body& body) {
  return body();
}

}  // namespace this_task_arena
}  // namespace tbb

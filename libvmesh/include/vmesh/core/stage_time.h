#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace vmesh {

/// Seconds spent in one stage of a run.
struct StageTime {
  std::string stage;
  double seconds = 0;
};

/// Measures stages one after the other.
class StageClock {
 public:
  /// Appends the time since construction or the last call.
  void lap(std::string stage, std::vector<StageTime>& stages) {
    const auto now = std::chrono::steady_clock::now();
    stages.push_back({std::move(stage), std::chrono::duration<double>(now - start_).count()});
    start_ = now;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace vmesh

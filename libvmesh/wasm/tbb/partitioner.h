#pragma once

namespace tbb {

struct simple_partitioner {};

}  // namespace tbb

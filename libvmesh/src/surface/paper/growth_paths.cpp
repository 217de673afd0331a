#include "surface/paper/growth_paths.h"

#include <algorithm>

namespace vmesh {

GrowthPaths::GrowthPaths(const Centerline& centerline)
    : centerline_(centerline),
      direction_(centerline.segments().size(), 0),
      start_(centerline.segments().size(), 0),
      reached_(centerline.segments().size(), 0),
      crossings_(centerline.segments().size(), 0),
      seen_(centerline.nodes().size(), 0) {}

void GrowthPaths::start_at(Index seed) {
  struct Arrival {
    Index node;
    double depth;
  };
  std::vector<Arrival> queue = {{seed, 0}};
  seen_[seed] = 1;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const Arrival arrival = queue[i];
    for (const Index s : centerline_.incident_segments(arrival.node)) {
      const Index next = centerline_.other_node(s, arrival.node);
      if (seen_[next]) continue;
      seen_[next] = 1;
      direction_[s] = centerline_.segment(s).a == arrival.node ? 1 : -1;
      start_[s] = reached_[s] = arrival.depth;
      queue.push_back({next, arrival.depth + centerline_.length(s)});
    }
  }
}

double GrowthPaths::depth(Index segment, double t) const {
  return start_[segment] + (direction_[segment] < 0 ? 1 - t : t) * centerline_.length(segment);
}

void GrowthPaths::advance(Index segment, double depth) {
  reached_[segment] = std::max(reached_[segment], depth);
  ++crossings_[segment];
}

}  // namespace vmesh

#pragma once

#include <utility>
#include <vector>

#include "volume/segment_locality.h"

namespace vmesh {

/// The contents of SegmentLocality as lists, for centerlines too large for tables.
struct LocalityPairs {
  using Pairs = std::vector<std::pair<Index, Index>>;

  Pairs local, parting, apart;   ///< each pair with the lower index first; but for those in one fan (Fans)
  std::vector<double> rounding;  ///< of every node; empty where it is 1 for all
};

/// Like segment_locality(), region by region on all threads. A centerline is divided into cells at nodes along
/// vessels whose spheres face only those of their own vessel: pairs of spheres are followed from one to the next, so
/// related segments lie in one cell, or right at the node. A region consists of consecutive cells along the graph.
/// `region_size`: least number of segments in a region.
LocalityPairs segment_locality_by_regions(const Centerline& centerline, double blend, std::size_t region_size = 2'000);

}  // namespace vmesh

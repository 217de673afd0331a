#include "volume/segment_locality_regions.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "vmesh/core/ascending.h"
#include "vmesh/core/box_tree.h"
#include "vmesh/core/disjoint_sets.h"

namespace vmesh {
namespace {

// Cosine of the angle by which a vessel may deviate from its direction at a border, and the share by which radii may
// differ there: then spheres between two that face each other do so as well. Compared with locality found at once, the
// same in 6,000 comparisons each (SegmentLocalityByRegions, 1,000 random seeds) from 0.56 to 0.95 and from 0.28 to
// 0.56, and with both at their loosest.
constexpr double kStraight = 0.8, kEven = 0.4;

// Finds the nodes at which cells end: their spheres face only those of their own vessel right before and after. Pairs
// of spheres are followed from sphere to sphere, so none gets past such a node.
class Borders {
 public:
  Borders(const Centerline& centerline, double blend) : centerline_(centerline), wide_(farthest_local(blend)) {
    boxes_ = BoxTree(static_cast<Index>(centerline.segments().size()), [&](Index s) {
      const auto &from = centerline.node(centerline.segment(s).a), &to = centerline.node(centerline.segment(s).b);
      const double widest = std::max(from.radius, to.radius), reach = widest + wide_.gap(widest, widest);
      return BoxTree::Box{from.position.cwiseMin(to.position).array() - reach,
                          from.position.cwiseMax(to.position).array() + reach};
    });
  }

  // The segments of the vessel that the node may face; empty if the node is not a border.
  std::vector<Index> faced_at(Index node) const {
    if (centerline_.degree(node) != 2) return {};
    std::vector<Index> own;
    const auto incident = centerline_.incident_segments(node);
    const Vec3 way = (position_beyond(node, incident[1]) - position_beyond(node, incident[0])).normalized();
    if (!follow(node, incident[0], -way, own) || !follow(node, incident[1], way, own)) return {};
    bool alone = true;
    const Vec3 p = centerline_.node(node).position;
    const double radius = centerline_.node(node).radius;
    const double around = 1.5 * radius;  // wider than any gap to a thinner vessel
    boxes_.visit_overlapping(p.array() - around, p.array() + around, [&](Index s) {
      alone = alone && (std::find(own.begin(), own.end(), s) != own.end() || !may_face(node, s));
    });
    if (!alone) own.clear();
    return own;
  }

 private:
  Vec3 position_beyond(Index node, Index segment) const {
    return centerline_.node(centerline_.other_node(segment, node)).position;
  }

  // Whether a sphere of the segment may face the node's sphere in the widest sense.
  bool may_face(Index node, Index segment) const {
    const auto& [a, b] = centerline_.segment(segment);
    const Vec3 origin = centerline_.node(a).position, axis = centerline_.node(b).position - origin;
    const Vec3 p = centerline_.node(node).position;
    const double t = std::clamp((p - origin).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
    const double widest = std::max(centerline_.node(a).radius, centerline_.node(b).radius);
    const double radius = centerline_.node(node).radius;
    return (p - origin - t * axis).norm() <= radius + widest + wide_.gap(radius, widest);
  }

  // Collects the segments along the vessel until they no longer face the node; false if it ends, branches, turns or
  // changes its width before.
  bool follow(Index node, Index segment, const Vec3& way, std::vector<Index>& own) const {
    const CenterlineNode& start = centerline_.node(node);
    for (;;) {
      own.push_back(segment);
      const Index next = centerline_.other_node(segment, node);
      const CenterlineNode& there = centerline_.node(next);
      const Vec3 step = there.position - centerline_.node(node).position, along = there.position - start.position;
      if (step.dot(way) < kStraight * step.norm() || along.dot(way) < kStraight * along.norm()) return false;
      if (std::abs(there.radius - start.radius) > kEven * start.radius) return false;
      if (along.norm() > start.radius + there.radius + wide_.gap(start.radius, there.radius)) return true;
      if (centerline_.degree(next) != 2) return false;
      const auto incident = centerline_.incident_segments(next);
      segment = incident[0] == segment ? incident[1] : incident[0];
      node = next;
    }
  }

  const Centerline& centerline_;
  Touch wide_;
  BoxTree boxes_;
};

// Cells, numbered by their first segments, and regions made of them.
class Cells {
 public:
  Cells(const Centerline& centerline, double blend, std::size_t region_size)
      : centerline_(centerline), number_(centerline.segments().size(), kNone), faced_(centerline.nodes().size()) {
    {
      const Borders borders(centerline, blend);
      tbb::parallel_for(std::size_t{0}, faced_.size(),
                        [&](std::size_t n) { faced_[n] = borders.faced_at(static_cast<Index>(n)); });
    }
    DisjointSets sets(number_.size());
    for (Index n = 0; n < faced_.size(); ++n) {
      const auto incident = centerline.incident_segments(n);
      for (std::size_t k = 1; !is_border(n) && k < incident.size(); ++k) sets.join(incident[0], incident[k]);
    }
    for (Index s = 0; s < number_.size(); ++s) {
      const Index first = sets.find(s);
      if (first == s) {
        number_[s] = static_cast<Index>(segments_.size());
        segments_.emplace_back();
      }
      number_[s] = number_[first];
      segments_[number_[s]].push_back(s);
    }
    region_.assign(segments_.size(), kNone);
    std::size_t size = region_size;
    for (const Index cell : in_order()) {
      if (size >= region_size) {
        regions_.emplace_back();
        size = 0;
      }
      region_[cell] = static_cast<Index>(regions_.size() - 1);
      regions_.back().push_back(cell);
      size += segments_[cell].size();
    }
  }

  std::size_t region_count() const { return regions_.size(); }
  Index region_of(Index segment) const { return region_[number_[segment]]; }

  // The segments of a region, and those beyond its borders that face them; ascending.
  std::vector<Index> segments_around(std::size_t region) const {
    std::vector<Index> segments;
    for (const Index cell : regions_[region]) {
      for (const Index s : segments_[cell]) {
        segments.push_back(s);
        for (const Index n : {centerline_.segment(s).a, centerline_.segment(s).b}) {
          if (is_border(n)) segments.insert(segments.end(), faced_[n].begin(), faced_[n].end());
        }
      }
    }
    sort_unique(segments);
    return segments;
  }

 private:
  bool is_border(Index node) const { return !faced_[node].empty(); }

  // Cells in depth-first order, so that consecutive cells are near each other.
  std::vector<Index> in_order() const {
    std::vector<std::vector<Index>> next(segments_.size());
    for (Index n = 0; n < faced_.size(); ++n) {
      if (!is_border(n)) continue;
      const auto incident = centerline_.incident_segments(n);
      next[number_[incident[0]]].push_back(number_[incident[1]]);
      next[number_[incident[1]]].push_back(number_[incident[0]]);
    }
    std::vector<Index> order, open;
    std::vector<char> seen(segments_.size(), 0);
    for (Index first = 0; first < segments_.size(); ++first) {
      open.push_back(first);
      while (!open.empty()) {
        const Index cell = open.back();
        open.pop_back();
        if (seen[cell]) continue;
        seen[cell] = 1;
        order.push_back(cell);
        open.insert(open.end(), next[cell].rbegin(), next[cell].rend());
      }
    }
    return order;
  }

  const Centerline& centerline_;
  std::vector<Index> number_;                 // for every segment, its cell
  std::vector<std::vector<Index>> faced_;     // for border nodes, the segments that they face
  std::vector<std::vector<Index>> segments_;  // of cells
  std::vector<Index> region_;                 // of every cell
  std::vector<std::vector<Index>> regions_;   // the cells of every region
};

struct RegionLocality {
  LocalityPairs pairs;
  std::vector<std::pair<Index, double>> shares;  // of nodes right at gaps
};

RegionLocality locality_of_region(const Centerline& centerline, double blend, const Cells& cells, std::size_t region) {
  const std::vector<Index> segments = cells.segments_around(region);
  std::vector<Index> nodes;
  for (const Index s : segments) nodes.insert(nodes.end(), {centerline.segment(s).a, centerline.segment(s).b});
  sort_unique(nodes);
  std::vector<CenterlineNode> part_nodes;
  std::vector<CenterlineSegment> part_segments;
  for (const Index n : nodes) part_nodes.push_back(centerline.node(n));
  for (const Index s : segments)
    part_segments.push_back({place_in(nodes, centerline.segment(s).a), place_in(nodes, centerline.segment(s).b)});
  const SegmentLocality locality = segment_locality_at_gaps({std::move(part_nodes), std::move(part_segments)}, blend);
  RegionLocality result;
  const auto keep_own = [&](const PairSet& from, LocalityPairs::Pairs& to) {
    for (const auto& [i, j] : from.pairs()) {
      if (cells.region_of(segments[i]) == region) to.emplace_back(segments[i], segments[j]);
    }
  };
  keep_own(locality.local, result.pairs.local);
  keep_own(locality.parting, result.pairs.parting);
  for (const auto& [i, j] : locality.apart.pairs()) result.pairs.apart.emplace_back(segments[i], segments[j]);
  for (Index n = 0; n < locality.rounding.size(); ++n) {
    if (locality.rounding[n] < 1) result.shares.emplace_back(nodes[n], locality.rounding[n]);
  }
  return result;
}

LocalityPairs listed(const SegmentLocality& locality) {
  const auto list = [](const PairSet& pairs) {
    return LocalityPairs::Pairs(pairs.pairs().begin(), pairs.pairs().end());
  };
  return {list(locality.local), list(locality.parting), list(locality.apart), locality.rounding};
}

void append(const LocalityPairs::Pairs& from, LocalityPairs::Pairs& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

LocalityPairs segment_locality_by_regions(const Centerline& centerline, double blend, std::size_t region_size) {
  if (centerline.segments().size() < 2 * region_size) return listed(segment_locality(centerline, blend));
  std::vector<RegionLocality> regions;
  {
    const Cells cells(centerline, blend, region_size);
    regions.resize(cells.region_count());
    tbb::parallel_for(std::size_t{0}, regions.size(),
                      [&](std::size_t r) { regions[r] = locality_of_region(centerline, blend, cells, r); });
  }
  LocalityPairs whole;
  std::vector<double> share(centerline.nodes().size(), 1);
  for (RegionLocality& region : regions) {
    append(region.pairs.local, whole.local);
    append(region.pairs.parting, whole.parting);
    append(region.pairs.apart, whole.apart);
    for (const auto& [node, least] : region.shares) share[node] = std::min(share[node], least);
    region = {};
  }
  sort_unique(whole.apart);  // pairs at borders are in two regions
  whole.rounding = grow_shares(centerline, std::move(share));
  return whole;
}

}  // namespace vmesh

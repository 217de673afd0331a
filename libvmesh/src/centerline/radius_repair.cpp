#include <limits>
#include <queue>
#include <sstream>
#include <tuple>

#include "vmesh/core/error.h"

#include "cleaning_steps.h"

namespace vmesh::cleaning {
namespace {

/// Finds, for every node without a radius, the two nearest nodes with one along the graph (Dijkstra, two labels).
class RadiusRepair {
 public:
  explicit RadiusRepair(Workspace& work) : work_(work), adjacency_(work.nodes.size(), work.segments) {}

  void run() {
    std::vector<Index> missing;
    for (Index n = 0; n < work_.nodes.size(); ++n) {
      if (work_.merged.find(n) == n && work_.nodes[n].radius <= 0) missing.push_back(n);
    }
    if (missing.empty()) return;
    labels_.resize(work_.nodes.size());
    spread();
    std::vector<double> radii;
    for (const Index n : missing) radii.push_back(radius_of(n));
    for (std::size_t i = 0; i < missing.size(); ++i) set_radius(missing[i], radii[i]);
  }

 private:
  struct Label {
    double distance = std::numeric_limits<double>::infinity();
    Index source = kNone;
  };
  struct Entry {
    double distance;
    Index node, source;
    bool operator>(const Entry& other) const {
      return std::tie(distance, node, source) > std::tie(other.distance, other.node, other.source);
    }
  };

  void spread() {
    for (Index n = 0; n < work_.nodes.size(); ++n) {
      if (work_.merged.find(n) == n && work_.nodes[n].radius > 0) relax(n, n, 0);
    }
    while (!queue_.empty()) {
      const Entry entry = queue_.top();
      queue_.pop();
      auto& [nearest, second] = labels_[entry.node];
      if (nearest.source == kNone) {
        nearest = {entry.distance, entry.source};
      } else if (second.source == kNone && nearest.source != entry.source) {
        second = {entry.distance, entry.source};
      } else {
        continue;
      }
      relax(entry.node, entry.source, entry.distance);
    }
  }

  /// Passes a source on to the neighbours without a radius. Nodes with a radius stop others' labels.
  void relax(Index n, Index source, double distance) {
    for (Index i = adjacency_.offsets[n]; i < adjacency_.offsets[n + 1]; ++i) {
      const auto& segment = work_.segments[adjacency_.segments[i]];
      const Index m = segment.a == n ? segment.b : segment.a;
      if (work_.nodes[m].radius <= 0 && labels_[m].second.source == kNone) {
        queue_.push({distance + work_.distance(n, m), m, source});
      }
    }
  }

  double radius_of(Index n) const {
    const auto& [nearest, second] = labels_[n];
    if (nearest.source == kNone) {
      throw InvalidInput(work_.raw.name_of_node(n) +
                         ": its radius is 0 and so is that of every node it is connected to; give a radius");
    }
    const double r1 = work_.nodes[nearest.source].radius;
    if (second.source == kNone) return r1;
    const double r2 = work_.nodes[second.source].radius;
    const double length = nearest.distance + second.distance;
    return length > 0 ? (r1 * second.distance + r2 * nearest.distance) / length : r1;
  }

  void set_radius(Index n, double radius) {
    work_.nodes[n].radius = radius;
    const auto& [nearest, second] = labels_[n];
    std::ostringstream text;
    text << work_.raw.name_of_node(n) << ": its radius is 0; set to " << radius << " mm, from "
         << work_.raw.place_of_node(nearest.source);
    if (second.source != kNone) text << " and " << work_.raw.place_of_node(second.source);
    work_.add(CleaningAction::Kind::repaired_radius, CleaningAction::Element::node, n, text.str());
  }

  struct Labels {
    Label nearest, second;
  };

  Workspace& work_;
  Adjacency adjacency_;
  std::vector<Labels> labels_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

void repair_radii(Workspace& work) { RadiusRepair(work).run(); }

}  // namespace vmesh::cleaning

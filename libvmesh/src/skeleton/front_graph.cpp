#include "front_graph.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>
#include <utility>

#include "vmesh/core/disjoint_sets.h"

namespace vmesh::skeleton {
namespace {

/// Lists by number in one vector: the members of list n are from offset[n] to offset[n + 1].
template <class Pairs>
void gather(std::size_t count, const Pairs& pairs, std::vector<Index>& offset, std::vector<Index>& members) {
  offset.assign(count + 1, 0);
  for (const auto& [list, member] : pairs) ++offset[list + 1];
  for (std::size_t n = 0; n < count; ++n) offset[n + 1] += offset[n];
  members.resize(offset[count]);
  std::vector<Index> next(offset.begin(), offset.end() - 1);
  for (const auto& [list, member] : pairs) members[next[list]++] = member;
}

}  // namespace

FrontGraph::FrontGraph(const VoxelGraph& graph, const std::vector<float>& length)
    : width_(graph.longest_step()), front_of_voxel_(graph.size(), kNone) {
  const auto level = [&](Index n) { return static_cast<int>(length[n] / width_); };
  DisjointSets sets(graph.size());
  std::vector<std::pair<Index, Index>> down;  // from a voxel to one in a lower band
  for (Index n = 0; n < graph.size(); ++n) {
    graph.visit_neighbours(n, [&](Index m, float) {
      if (level(m) == level(n)) {
        if (m < n) sets.join(m, n);
      }
    });
  }
  for (Index n = 0; n < graph.size(); ++n) {
    const Index first = sets.find(n);  // the lowest number, so it comes before the others
    if (first == n) {
      front_of_voxel_[n] = static_cast<Index>(level_.size());
      level_.push_back(level(n));
      first_voxel_.push_back(n);
    } else {
      front_of_voxel_[n] = front_of_voxel_[first];
    }
  }
  std::vector<std::pair<Index, Index>> members;
  members.reserve(graph.size());
  for (Index n = 0; n < graph.size(); ++n) members.emplace_back(front_of_voxel_[n], n);
  gather(level_.size(), members, offset_, voxels_);
  members = {};
  for (Index front = 0; front < level_.size(); ++front) {
    const std::size_t begin = down.size();
    for (Index at = offset_[front]; at < offset_[front + 1]; ++at) {
      graph.visit_neighbours(voxels_[at], [&](Index m, float) {
        const Index other = front_of_voxel_[m];
        if (level_[other] >= level_[front]) return;
        if (down.size() > begin && down.back().second == other) return;
        down.emplace_back(front, other);
      });
    }
    std::sort(down.begin() + static_cast<std::ptrdiff_t>(begin), down.end());
    down.erase(std::unique(down.begin() + static_cast<std::ptrdiff_t>(begin), down.end()), down.end());
  }
  gather(level_.size(), down, below_at_, below_);
}

std::vector<FrontGraph::Meeting> FrontGraph::meetings() const {
  std::vector<Meeting> meetings;
  for (Index front = 0; front < level_.size(); ++front)
    for (Index at = below_at_[front] + 1; at < below_at_[front + 1]; ++at)
      meetings.push_back({front, below_[below_at_[front]], below_[at]});
  std::stable_sort(meetings.begin(), meetings.end(),
                   [&](const Meeting& a, const Meeting& b) { return level_[a.front] < level_[b.front]; });
  return meetings;
}

/// Goes down from both fronts at once, the highest front first, until they meet: at the highest place where they can.
FrontGraph::Loop FrontGraph::loop_at(Index front, Index first, Index second) const {
  Loop loop{kNone, front, {}, 0};
  std::unordered_map<Index, int> side_of;
  std::priority_queue<std::pair<int, Index>> queue;
  const auto reach = [&](Index f, int side) {
    const auto [at, fresh] = side_of.try_emplace(f, side);
    if (fresh) {
      queue.emplace(level_[f], f);
    } else if (at->second != side && (loop.parting == kNone || level_[f] > level_[loop.parting])) {
      loop.parting = f;
    }
  };
  reach(first, 0);
  reach(second, 1);
  while (!queue.empty() && (loop.parting == kNone || queue.top().first > level_[loop.parting])) {
    const Index f = queue.top().second;
    queue.pop();
    for (Index at = below_at_[f]; at < below_at_[f + 1]; ++at) reach(below_[at], side_of[f]);
  }
  if (loop.parting == kNone) return loop;
  loop.persistence = width_ * (level_[front] - level_[loop.parting]);
  for (const auto& [f, side] : side_of)
    if (f != loop.parting && level_[f] >= level_[loop.parting]) loop.sides[side].push_back(f);
  for (std::vector<Index>& side : loop.sides) std::sort(side.begin(), side.end());
  return loop;
}

}  // namespace vmesh::skeleton

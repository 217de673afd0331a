#include "mesh/close_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include "mesh/blocks.h"

namespace vmesh {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kBits = 21;  // of each coordinate on the curve

float rounded_down(double x) {
  const auto rounded = static_cast<float>(x);
  return rounded <= x ? rounded : std::nextafter(rounded, -kInfinity);
}

float rounded_up(double x) {
  const auto rounded = static_cast<float>(x);
  return rounded >= x ? rounded : std::nextafter(rounded, kInfinity);
}

// The lowest 21 bits, two zeros between each two.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1F00000000FFFF;
  x = (x | x << 16) & 0x1F0000FF0000FF;
  x = (x | x << 8) & 0x100F00F00F00F00F;
  x = (x | x << 4) & 0x10C30C30C30C30C3;
  return (x | x << 2) & 0x1249249249249249;
}

// Pieces of a growing surface are sorted on one thread each.
template <class T>
void sort_on_all_threads(std::vector<T>& items) {
  constexpr std::size_t kLeast = 1 << 14;
  if (items.size() < kLeast) {
    std::sort(items.begin(), items.end());
  } else {
    tbb::this_task_arena::isolate([&] { tbb::parallel_sort(items.begin(), items.end()); });
  }
}

}  // namespace

void CloseFaces::Box::enclose(const Box& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    low[i] = std::min(low[i], other.low[i]);
    high[i] = std::max(high[i], other.high[i]);
  }
}

CloseFaces::Box CloseFaces::box_of(const TriMesh& mesh, Index face) {
  const auto& [a, b, c] = mesh.faces[face];
  const Vec3 low = mesh.vertices[a].cwiseMin(mesh.vertices[b]).cwiseMin(mesh.vertices[c]);
  const Vec3 high = mesh.vertices[a].cwiseMax(mesh.vertices[b]).cwiseMax(mesh.vertices[c]);
  return {{rounded_down(low.x()), rounded_down(low.y()), rounded_down(low.z())},
          {rounded_up(high.x()), rounded_up(high.y()), rounded_up(high.z())}};
}

CloseFaces::CloseFaces(const TriMesh& mesh, std::vector<Index> faces) : faces_(std::move(faces)) {
  sort(mesh, 0, faces_.size());
  build(mesh);
}

CloseFaces::CloseFaces(const TriMesh& mesh, std::vector<Index> faces, std::vector<Index> parts)
    : faces_(std::move(faces)), part_(std::move(parts)) {
  for (std::size_t begin = 0, end = 0; begin < faces_.size(); begin = end) {
    while (end < faces_.size() && part_[end] == part_[begin]) ++end;
    sort(mesh, begin, end);
  }
  build(mesh);
  note_parts();
}

void CloseFaces::note_parts() {
  part_below_.assign(2 * leaves_, kNone);
  for (std::size_t block = 0; block < blocks_; ++block) {
    if (part_[block * kBlock] == part_[end_of(block) - 1]) part_below_[leaves_ + block] = part_[block * kBlock];
  }
  for (std::size_t node = leaves_; --node > 0;) {
    const std::size_t left = 2 * node, right = 2 * node + 1;
    if (last_block_[right] == 0 || part_below_[left] == part_below_[right]) part_below_[node] = part_below_[left];
  }
}

void CloseFaces::build(const TriMesh& mesh) {
  boxes_.resize(faces_.size());
  for_blocks(faces_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) boxes_[i] = box_of(mesh, faces_[i]);
  });
  blocks_ = (faces_.size() + kBlock - 1) / kBlock;
  while (leaves_ < blocks_) leaves_ *= 2;
  const Box nothing{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  nodes_.assign(2 * leaves_, nothing);
  last_block_.assign(2 * leaves_, 0);
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    nodes_[leaves_ + i / kBlock].enclose(boxes_[i]);
    last_block_[leaves_ + i / kBlock] = static_cast<Index>(i / kBlock + 1);
  }
  for (std::size_t node = leaves_; --node > 0;) {
    for (const std::size_t child : {2 * node, 2 * node + 1}) {
      nodes_[node].enclose(nodes_[child]);
      last_block_[node] = std::max(last_block_[node], last_block_[child]);
    }
  }
}

// Sorts along the Z curve by the faces' centres.
void CloseFaces::sort(const TriMesh& mesh, std::size_t begin, std::size_t end) {
  if (begin == end) return;
  const std::span<Index> faces(faces_.data() + begin, end - begin);
  const auto middle = [&](Index f) -> Vec3 {
    const auto& [a, b, c] = mesh.faces[f];
    return (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
  };
  Vec3 low = middle(faces.front()), high = low;
  for (const Index f : faces) {
    low = low.cwiseMin(middle(f));
    high = high.cwiseMax(middle(f));
  }
  const double size = (high - low).maxCoeff();
  const double scale = size > 0 ? ((1 << kBits) - 1) / size : 0;
  std::vector<std::pair<std::uint64_t, Index>> order(faces.size());
  for_blocks(faces.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const Vec3 at = scale * (middle(faces[k]) - low);
      std::uint64_t key = 0;
      for (int i = 0; i < 3; ++i) key |= spread(static_cast<std::uint64_t>(at[i])) << i;
      order[k] = {key, faces[k]};
    }
  });
  sort_on_all_threads(order);
  for (std::size_t i = 0; i < order.size(); ++i) faces[i] = order[i].second;
}

}  // namespace vmesh

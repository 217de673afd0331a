#include "page/packing.h"
#include "page/page.h"

namespace vmesh::tool {
namespace {

/// A vertex takes about three bytes per frame, four in base64.
constexpr double kBytesOfVertex = 4, kMostBytes = 16e6;

std::vector<Vec3> joined(const std::vector<Vec3>& vertices, const std::vector<Vec3>& nodes) {
  std::vector<Vec3> all = vertices;
  all.insert(all.end(), nodes.begin(), nodes.end());
  return all;
}

}  // namespace

PageFrames::PageFrames(const TriMesh& mesh, const Centerline& centerline, std::size_t count) : count_(count) {
  const PointGrid grid = grid_over(mesh.vertices);
  low_ = grid.low;
  step_ = grid.step;
  const double points = static_cast<double>(mesh.vertices.size() + centerline.nodes().size());
  every_ += static_cast<std::size_t>(points * kBytesOfVertex * static_cast<double>(count) / kMostBytes);
}

void PageFrames::add(double time_s, const std::vector<Vec3>& vertices, const std::vector<Vec3>& nodes) {
  const std::size_t frame = seen_++;
  if (frame % every_ != 0 && frame + 1 != count_) return;
  std::vector<std::int64_t> places = on_grid(joined(vertices, nodes), {low_, step_}), moves = places;
  for (std::size_t i = 0; i < last_.size(); ++i) moves[i] -= last_[i];
  last_ = std::move(places);
  time_s_.push_back(time_s);
  packed_.push_back(pack(moves, 3));
}

}  // namespace vmesh::tool

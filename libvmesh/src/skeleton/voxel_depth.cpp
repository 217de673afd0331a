#include "voxel_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vmesh::skeleton {
namespace {

/// The lower envelope of parabolas over the places of one run, places 0 and run.size() + 1 being outside.
class Envelope {
 public:
  /// Replaces values[run[p - 1]] by the least of value(q) + (step * (p - q))^2 over all places q.
  void apply(const std::vector<Index>& run, double step, std::vector<float>& values) {
    const auto end = static_cast<int>(run.size()) + 1;
    value_.assign(static_cast<std::size_t>(end) + 1, 0);
    for (int p = 1; p < end; ++p) value_[p] = values[run[p - 1]] / (step * step);
    lowest_.clear();
    from_.clear();
    for (int p = 0; p <= end; ++p) add(p);
    std::size_t at = 0;
    for (int p = 1; p < end; ++p) {
      while (at + 1 < lowest_.size() && from_[at + 1] < p) ++at;
      const double away = p - lowest_[at];
      values[run[p - 1]] = static_cast<float>((value_[lowest_[at]] + away * away) * step * step);
    }
  }

 private:
  void add(int p) {
    double from = -std::numeric_limits<double>::infinity();
    while (!lowest_.empty()) {
      const int q = lowest_.back();
      from = ((value_[p] + static_cast<double>(p) * p) - (value_[q] + static_cast<double>(q) * q)) / (2.0 * (p - q));
      if (from > from_.back()) break;
      lowest_.pop_back();
      from_.pop_back();
      from = -std::numeric_limits<double>::infinity();
    }
    lowest_.push_back(p);
    from_.push_back(from);
  }

  std::vector<double> value_;  // in steps squared
  std::vector<int> lowest_;    // places whose parabolas form the envelope
  std::vector<double> from_;   // where each begins
};

/// Calls visit(run) with the voxel numbers of every run along an axis.
template <class Visit>
void visit_runs(const VoxelGraph& graph, int axis, Visit&& visit) {
  std::vector<Index> run;
  for (Index n = 0; n < graph.size(); ++n) {
    Voxel v = graph.voxel(n);
    --v[axis];
    if (graph.set().contains(v)) continue;
    run.clear();
    ++v[axis];
    for (Index m = n; m != kNone; m = graph.set().number(v)) {
      run.push_back(m);
      ++v[axis];
    }
    visit(run);
  }
}

constexpr int kReach = 2;  // voxels: where a Gaussian of one voxel is down to a seventh
constexpr int kPatch = VoxelSet::kSide + 2 * kReach;

/// Whether voxels are inside, 1 or 0, in and around a block.
using BlockPatch = std::array<float, kPatch * kPatch * kPatch>;

void fill(const VoxelSet& voxels, const VoxelSet::Block& block, BlockPatch& patch) {
  std::size_t at = 0;
  for (int k = -kReach; k < VoxelSet::kSide + kReach; ++k) {
    for (int j = -kReach; j < VoxelSet::kSide + kReach; ++j) {
      const Voxel row = {block.corner[0], block.corner[1] + j, block.corner[2] + k};
      // The row's bits in this block and the ends of its neighbours, lowest first.
      unsigned bits = 0;
      for (int side = -1; side <= 1; ++side) {
        const VoxelSet::Block* other = voxels.block_of({row[0] + side * VoxelSet::kSide, row[1], row[2]});
        if (other == nullptr) continue;
        const auto eight = static_cast<unsigned>(other->layers[row[2] & 7] >> ((row[1] & 7) << 3) & 0xff);
        bits |= eight << (side + 1) * VoxelSet::kSide;
      }
      bits >>= VoxelSet::kSide - kReach;
      for (int i = 0; i < kPatch; ++i) patch[at++] = static_cast<float>(bits >> i & 1);
    }
  }
}

std::array<float, kReach + 1> gaussian() {
  std::array<float, kReach + 1> weights{};
  double sum = 0;
  for (int i = 0; i <= kReach; ++i) sum += (i == 0 ? 1 : 2) * std::exp(-0.5 * i * i);
  for (int i = 0; i <= kReach; ++i) weights[i] = static_cast<float>(std::exp(-0.5 * i * i) / sum);
  return weights;
}

/// Smooths along the axis with this stride; the first `lines` values of every kPatch * stride are meaningful.
void smooth(BlockPatch& patch, int stride) {
  static const std::array<float, kReach + 1> weights = gaussian();
  BlockPatch result{};
  const int count = static_cast<int>(patch.size());
  for (int n = kReach * stride; n < count - kReach * stride; ++n)
    result[n] = weights[0] * patch[n] + weights[1] * (patch[n - stride] + patch[n + stride]) +
                weights[2] * (patch[n - 2 * stride] + patch[n + 2 * stride]);
  patch = result;
}

}  // namespace

std::vector<float> boundary_distances(const VoxelGraph& graph) {
  std::vector<float> squares(graph.size());
  visit_runs(graph, 0, [&](const std::vector<Index>& run) {
    for (std::size_t p = 0; p < run.size(); ++p) {
      const double away = graph.spacing()[0] * static_cast<double>(std::min(p + 1, run.size() - p));
      squares[run[p]] = static_cast<float>(away * away);
    }
  });
  Envelope envelope;
  for (int axis = 1; axis < 3; ++axis)
    visit_runs(graph, axis,
               [&](const std::vector<Index>& run) { envelope.apply(run, graph.spacing()[axis], squares); });
  for (float& value : squares) value = std::sqrt(value);
  return squares;
}

std::vector<float> smoothed_occupancy(const VoxelSet& voxels) {
  std::vector<float> occupancy(voxels.size());
  BlockPatch patch;
  for (const VoxelSet::Block& block : voxels.blocks()) {
    fill(voxels, block, patch);
    smooth(patch, 1);
    smooth(patch, kPatch);
    smooth(patch, kPatch * kPatch);
    Index n = block.first;
    for (int k = 0; k < VoxelSet::kSide; ++k) {
      for (std::uint64_t rest = block.layers[k]; rest != 0; rest &= rest - 1) {
        const int place = std::countr_zero(rest);
        const int i = (place & 7) + kReach, j = (place >> 3) + kReach;
        occupancy[n++] = patch[((k + kReach) * kPatch + j) * kPatch + i];
      }
    }
  }
  return occupancy;
}

}  // namespace vmesh::skeleton

#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "vmesh/surface/generate.h"

#include "fit/fit_steps.h"

namespace vmesh::fitting {

/// A dense fit and what it is turned into: few triangles that are long where the reference is curved little. Keeps
/// references.
class LongTriangles {
 public:
  /// `surface`: packed, even and dense; `round`: called before each round.
  LongTriangles(FitMesh& surface, std::vector<Opening>& openings, const FitSetting& setting,
                const std::vector<ReferenceSample>& samples, std::function<void()> round);

  /// Coarsens the surface to `vertices` vertices and fits it again; then, a few times, adds some where it is farthest
  /// from the reference and leaves out others.
  /// `deformable`: see FitOptions.
  void make(std::size_t vertices, double elongation, bool deformable);

 private:
  void refit();
  void exchange(std::size_t vertices);
  void coarsen_to(std::size_t vertices);
  void split_far_edges(const Matches& matches, const std::vector<char>& frozen, std::size_t count);
  Matches next_matches(bool edges = false);

  FitMesh& surface_;
  std::vector<Opening>& openings_;
  FitSetting setting_;
  bool deformable_ = false;
  const std::vector<ReferenceSample>& samples_;
  std::function<void()> round_;
};

}  // namespace vmesh::fitting

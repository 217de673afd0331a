// A tree and the surface around it, at rest, that may be cut again and again, as the command cuts those of a scene.
#pragma once

#include <vector>

#include "vmesh/centerline/cut.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

struct RestTree {
  Centerline centerline;
  TriMesh mesh;
  std::vector<Vec3> normals;  ///< of vertices
  std::vector<CenterlineBinding> binding;
};

/// Places are those of the whole tree, before all cuts, unless it says otherwise.
class PartedTree {
 public:
  explicit PartedTree(RestTree whole) { stages_.push_back(std::move(whole)); }

  const RestTree& now() const { return stages_[cuts_]; }
  SegmentPlace now(SegmentPlace place) const;
  /// The place of the whole tree that is now there.
  SegmentPlace whole(SegmentPlace place) const;

  /// The next cut; the same as before at the same place. Throws InvalidInput where there can be none. Nothing has
  /// changed until go_on().
  const CenterlineCut& next_cut(const SegmentPlace& at);
  void go_on() { ++cuts_; }
  bool is_whole() const { return cuts_ == 0; }
  /// Whole again.
  void restart() { cuts_ = 0; }

 private:
  struct Made {
    SegmentPlace at;
    CenterlineCut cut;
  };
  CenterlineCut cut_there(const SegmentPlace& at) const;

  std::vector<RestTree> stages_;  // whole, and after each of the cuts
  std::vector<Made> made_;
  std::size_t cuts_ = 0;
};

}  // namespace vmesh

#include <algorithm>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "vmesh/core/box_tree.h"
#include "vmesh/mesh/face_pair.h"
#include "vmesh/mesh/topology.h"

#include "mesh/blocks.h"
#include "mesh/close_faces.h"

namespace vmesh {
namespace {

constexpr std::size_t kLeastPart = 4096, kMostParts = 64;  // blocks of a part; parts

std::vector<Index> faces_with_area(const TriMesh& mesh) {
  const std::vector<Index> degenerate = degenerate_faces(mesh);
  std::vector<Index> faces;
  faces.reserve(mesh.faces.size());
  auto skipped = degenerate.begin();
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (skipped != degenerate.end() && *skipped == f) {
      ++skipped;
    } else {
      faces.push_back(f);
    }
  }
  return faces;
}

struct Bounds {
  Vec3 low, high;

  explicit Bounds(const TriMesh& mesh, Index face) : low(mesh.vertices[mesh.faces[face][0]]), high(low) {
    enclose(mesh, face);
  }
  void enclose(const TriMesh& mesh, Index face) {
    for (const Index v : mesh.faces[face]) {
      low = low.cwiseMin(mesh.vertices[v]);
      high = high.cwiseMax(mesh.vertices[v]);
    }
  }
  bool meets(const Vec3& other_low, const Vec3& other_high) const {
    return (low.array() <= other_high.array()).all() && (other_low.array() <= high.array()).all();
  }
};

// Boxes around the parts of a mesh: a face outside the boxes of all other parts meets none of them.
class PartBoxes {
 public:
  PartBoxes(const TriMesh& mesh, std::span<const Index> first_face) {
    for (Index part = 0; part < first_face.size(); ++part) {
      const std::size_t end = part + 1 < first_face.size() ? first_face[part + 1] : mesh.faces.size();
      if (first_face[part] == end) continue;
      Bounds bounds(mesh, first_face[part]);
      for (Index f = first_face[part]; f < end; ++f) bounds.enclose(mesh, f);
      parts_.push_back(part);
      low_.push_back(bounds.low);
      high_.push_back(bounds.high);
    }
    tree_ = BoxTree(low_, high_);
  }

  bool reaches_others(const TriMesh& mesh, Index face, Index part) const {
    const Bounds bounds(mesh, face);
    bool reaches = false;
    tree_.visit_overlapping(bounds.low, bounds.high, [&](Index i) {
      reaches = reaches || (parts_[i] != part && bounds.meets(low_[i], high_[i]));
    });
    return reaches;
  }

 private:
  std::vector<Index> parts_;  // those that have faces
  std::vector<Vec3> low_, high_;
  BoxTree tree_;
};

std::vector<std::pair<Index, Index>> intersecting(const TriMesh& mesh, const CloseFaces& close) {
  const auto placed = [&](Index f) {
    const auto& [a, b, c] = mesh.faces[f];
    return PlacedFace{mesh.faces[f], {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}};
  };
  // Pieces of a growing surface are tested on one thread each; only larger meshes are divided.
  const std::size_t part = std::max(kLeastPart, (close.block_count() + kMostParts - 1) / kMostParts);
  std::vector<std::vector<std::pair<Index, Index>>> found((close.block_count() + part - 1) / part);
  const auto test = [&](std::size_t p) {
    for (std::size_t block = p * part; block < std::min(close.block_count(), (p + 1) * part); ++block) {
      close.visit_pairs_of(block, [&](Index f, Index g) {
        if (intersect(placed(f), placed(g))) found[p].push_back(std::minmax(f, g));
      });
    }
  };
  // Isolated: a thread that waits for this must not start on another piece.
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, found.size(), test); });
  std::vector<std::pair<Index, Index>> pairs;
  for (const auto& some : found) pairs.insert(pairs.end(), some.begin(), some.end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

std::vector<std::pair<Index, Index>> self_intersections(const TriMesh& mesh) {
  return intersecting(mesh, CloseFaces(mesh, faces_with_area(mesh)));
}

std::vector<std::pair<Index, Index>> intersections_between(const TriMesh& mesh, std::span<const Index> first_face) {
  const PartBoxes boxes(mesh, first_face);
  const auto part_of = [&](Index f) {
    const auto next = std::upper_bound(first_face.begin(), first_face.end(), f);
    return static_cast<Index>(next - first_face.begin() - 1);
  };
  const std::vector<Index> all = faces_with_area(mesh);
  std::vector<Index> faces =
      joined_lists(of_blocks<std::vector<Index>>(all.size(), [&](std::size_t i, std::size_t end) {
        std::vector<Index> reaching;
        for (; i < end; ++i) {
          if (boxes.reaches_others(mesh, all[i], part_of(all[i]))) reaching.push_back(all[i]);
        }
        return reaching;
      }));
  std::vector<Index> parts;
  for (const Index f : faces) parts.push_back(part_of(f));
  return intersecting(mesh, CloseFaces(mesh, std::move(faces), std::move(parts)));
}

}  // namespace vmesh

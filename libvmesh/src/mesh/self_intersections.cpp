#include <algorithm>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include "vmesh/core/box_tree.h"
#include "vmesh/mesh/topology.h"

namespace vmesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

constexpr double kMargin = 1e-9;  // of edges and distance: below it exact predicates decide; rounding is 1e-15 of them

class FacePairTest {
 public:
  explicit FacePairTest(const TriMesh& mesh) : mesh_(mesh) {}

  bool intersect(Index f, Index g) const {
    const Triangle& x = mesh_.faces[f];
    const Triangle& y = mesh_.faces[g];
    Index common[3];
    int count = 0;
    for (const Index v : x) {
      if (std::find(y.begin(), y.end(), v) != y.end()) common[count++] = v;
    }
    if (count == 3) return true;
    if (count < 2 && (on_one_side(x, y, common, count) || on_one_side(y, x, common, count))) return false;
    if (count == 2) return folded(common[0], common[1], apex(x, common), apex(y, common));
    if (count == 1) return opposite_edge_meets(x, y, common[0]) || opposite_edge_meets(y, x, common[0]);
    return CGAL::do_intersect(triangle(x), triangle(y));
  }

 private:
  Point point(Index v) const { return {mesh_.vertices[v].x(), mesh_.vertices[v].y(), mesh_.vertices[v].z()}; }
  Kernel::Triangle_3 triangle(const Triangle& t) const { return {point(t[0]), point(t[1]), point(t[2])}; }

  // Whether the corners of `other` that are not common lie beyond doubt on one side of the plane of `face`: the two
  // then meet in common corners at most. The margin is far above the rounding of the determinant.
  bool on_one_side(const Triangle& face, const Triangle& other, const Index common[3], int count) const {
    const Vec3& base = mesh_.vertices[face[0]];
    const Vec3 first = mesh_.vertices[face[1]] - base, second = mesh_.vertices[face[2]] - base;
    const Vec3 normal = first.cross(second);
    const double margin = kMargin * kMargin * first.squaredNorm() * second.squaredNorm();
    int above = 0, below = 0;
    for (const Index v : other) {
      if (std::find(common, common + count, v) != common + count) continue;
      const Vec3 away = mesh_.vertices[v] - base;
      const double height = normal.dot(away);
      if (!(height * height > margin * away.squaredNorm())) return false;
      ++(height > 0 ? above : below);
    }
    return above == 0 || below == 0;
  }

  static Index apex(const Triangle& t, const Index edge[2]) {
    return *std::find_if(t.begin(), t.end(), [&](Index v) { return v != edge[0] && v != edge[1]; });
  }

  // Two faces at an edge overlap only when they are coplanar and lie on the same side of it.
  bool folded(Index a, Index b, Index c, Index d) const {
    return CGAL::coplanar(point(a), point(b), point(c), point(d)) &&
           CGAL::coplanar_orientation(point(a), point(b), point(c), point(d)) == CGAL::POSITIVE;
  }

  bool opposite_edge_meets(const Triangle& x, const Triangle& y, Index common) const {
    const auto i = std::find(x.begin(), x.end(), common) - x.begin();
    return CGAL::do_intersect(triangle(y), Kernel::Segment_3(point(x[(i + 1) % 3]), point(x[(i + 2) % 3])));
  }

  const TriMesh& mesh_;
};

}  // namespace

std::vector<std::pair<Index, Index>> self_intersections(const TriMesh& mesh) {
  const FacePairTest test(mesh);
  std::vector<Index> faces;
  std::vector<Vec3> low, high;
  const std::vector<Index> degenerate = degenerate_faces(mesh);
  auto skipped = degenerate.begin();
  for (auto* corners : {&low, &high}) corners->reserve(mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (skipped != degenerate.end() && *skipped == f) {
      ++skipped;
      continue;
    }
    const Vec3 &a = mesh.vertices[mesh.faces[f][0]], &b = mesh.vertices[mesh.faces[f][1]],
               &c = mesh.vertices[mesh.faces[f][2]];
    faces.push_back(f);
    low.push_back(a.cwiseMin(b).cwiseMin(c));
    high.push_back(a.cwiseMax(b).cwiseMax(c));
  }
  std::vector<std::pair<Index, Index>> pairs;
  BoxTree(low, high).visit_pairs([&](Index i, Index j) {
    if ((low[i].array() > high[j].array()).any() || (low[j].array() > high[i].array()).any()) return;
    if (test.intersect(faces[i], faces[j])) pairs.push_back(std::minmax(faces[i], faces[j]));
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace vmesh

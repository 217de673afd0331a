#include "fit/guarded_step.h"

#include <algorithm>
#include <utility>

#include "vmesh/edit/crossing_guard.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/metric_skewness.h"

namespace vmesh::fitting {
namespace {

constexpr int kHalvings = 3;  // then the vertex stays

Vec3 normal_of(const std::array<Vec3, 3>& corners) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double norm = normal.norm();
  return norm > 0 ? Vec3(normal / norm) : Vec3(Vec3::Zero());
}

class CommonStep {
 public:
  CommonStep(FitMesh& surface, const std::vector<Vec3>& steps, const StepGuard& guard)
      : surface_(surface), steps_(steps), guard_(guard), halvings_(steps.size(), 0) {
    for (const FitVertex& v : surface.vertices()) before_.push_back(v.position);
    for (Index f = 0; f < surface.faces().size(); ++f) {
      normals_.push_back(surface.unit_normal(f));
      skewness_.push_back(skewness_of(surface, f));
    }
    for (Index v = 0; v < steps.size(); ++v) place(v);
  }

  void keep_shapes() {
    std::vector<Index> faces(surface_.faces().size());
    for (Index f = 0; f < faces.size(); ++f) faces[f] = f;
    while (!faces.empty()) {
      std::vector<Index> moved;
      for (const Index f : faces) {
        if (is_good(f)) continue;
        for (const Index v : surface_.faces()[f]) moved.push_back(v);
      }
      faces = shorten(std::move(moved));
    }
  }

  void keep_apart() {
    std::vector<std::pair<Index, Index>> crossing = self_intersections(surface_.tri_mesh());
    while (true) {
      moved_.clear();
      std::vector<Index> moved;
      for (const auto& [f, g] : crossing) {
        for (const Index face : {f, g}) {
          for (const Index v : surface_.faces()[face]) moved.push_back(v);
        }
      }
      if (shorten(std::move(moved)).empty()) return;
      keep_shapes();
      crossing = crossing_around(std::exchange(moved_, {}));
    }
  }

  double taken() const {
    double wanted = 0, done = 0;
    for (Index v = 0; v < steps_.size(); ++v) {
      wanted += steps_[v].norm();
      done += (surface_.position(v) - before_[v]).norm();
    }
    return wanted > 0 ? done / wanted : 1;
  }

 private:
  void place(Index v) {
    const double share = halvings_[v] > kHalvings ? 0 : 1.0 / (1 << halvings_[v]);
    surface_.edit(v).position = before_[v] + share * steps_[v];
  }

  // Returns the faces that changed, and those beside them.
  std::vector<Index> shorten(std::vector<Index> vertices) {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Index> faces;
    for (const Index v : vertices) {
      if (halvings_[v] > kHalvings) continue;
      ++halvings_[v];
      place(v);
      moved_.push_back(v);
      for (const Index f : surface_.faces_around(v)) {
        for (const Index w : surface_.faces()[f])
          faces.insert(faces.end(), surface_.faces_around(w).begin(), surface_.faces_around(w).end());
      }
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }

  bool is_good(Index f) const {
    const Vec3 normal = normal_of(surface_.corners(f));
    if (!(normal.dot(normals_[f]) >= guard_.turn)) return false;
    if (skewness_of(surface_, f) > std::max(guard_.max_skewness, skewness_[f] + 1e-9)) return false;
    const Triangle& face = surface_.faces()[f];
    for (int i = 0; i < 3; ++i) {
      const Index g = surface_.face_of(face[(i + 1) % 3], face[i]);
      if (g == kNone) continue;
      if (!may_fold(normal.dot(normal_of(surface_.corners(g))), normals_[f].dot(normals_[g]), guard_.fold))
        return false;
    }
    return true;
  }

  // Pairs of crossing faces of which one has a moved vertex: other pairs are unchanged.
  std::vector<std::pair<Index, Index>> crossing_around(const std::vector<Index>& vertices) const {
    std::vector<Index> moved;
    for (const Index v : vertices)
      moved.insert(moved.end(), surface_.faces_around(v).begin(), surface_.faces_around(v).end());
    return crossing_pairs(surface_.positions(), surface_.faces(), moved);
  }

  FitMesh& surface_;
  const std::vector<Vec3>& steps_;
  const StepGuard& guard_;
  std::vector<Vec3> before_, normals_;
  std::vector<double> skewness_;
  std::vector<int> halvings_;
  std::vector<Index> moved_;  // by shorten(), some of them more than once
};

}  // namespace

double skewness_with(const FitMesh& surface, Index face, Index vertex, const Vec3& p) {
  std::array<Vec3, 3> corners = surface.corners(face);
  for (int i = 0; i < 3; ++i) {
    if (surface.faces()[face][i] == vertex) corners[i] = p;
  }
  return skewness_at(surface, surface.faces()[face], corners);
}

double skewness_at(const FitMesh& surface, const Triangle& face, const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = face;
  return metric_skewness(corners,
                         {surface.vertex(a).elongation, surface.vertex(b).elongation, surface.vertex(c).elongation});
}

double skewness_after(const FitMesh& surface, const Triangle& face, const FitMesh::Step& step) {
  std::array<Vec3, 3> elongation;
  for (std::size_t i = 0; i < 3; ++i)
    elongation[i] = face[i] == step.vertex ? step.target.elongation : surface.vertex(face[i]).elongation;
  return metric_skewness(surface.placed(face, step).points, elongation);
}

double skewness_of(const FitMesh& surface, Index face) {
  return skewness_at(surface, surface.faces()[face], surface.corners(face));
}

double take_steps(FitMesh& surface, const std::vector<Vec3>& steps, const StepGuard& guard) {
  CommonStep step(surface, steps, guard);
  step.keep_shapes();
  step.keep_apart();
  return step.taken();
}

}  // namespace vmesh::fitting

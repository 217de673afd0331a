#include "surface/proof/patch.h"

#include <algorithm>

#include "vmesh/mesh/triangle_quality.h"

namespace vmesh {
namespace {

constexpr Triangle kDead = {kNone, kNone, kNone};
constexpr int kMendRounds = 4;  // idle 3 to 6

bool has(const Triangle& f, Index v) { return std::find(f.begin(), f.end(), v) != f.end(); }

Triangle replaced(Triangle f, Index from, Index to) {
  std::replace(f.begin(), f.end(), from, to);
  return f;
}

double skewness(const PlacedFace& f) { return equiangle_skewness(f.points[0], f.points[1], f.points[2]); }

std::pair<Vec3, Vec3> box_of(const PlacedFace& f) {
  const auto& [a, b, c] = f.points;
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

}  // namespace

Patch::Patch(FinishedSurface& surface, const VesselField& field)
    : surface_(surface),
      field_(field),
      faces_at_(surface.mesh.vertices.size()),
      changed_(surface.mesh.faces.size(), 0) {
  std::vector<Vec3> low, high;
  for (Index f = 0; f < surface.mesh.faces.size(); ++f) {
    for (const Index v : surface.mesh.faces[f]) faces_at_[v].push_back(f);
    const auto box = box_of(placed(surface.mesh.faces[f]));
    low.push_back(box.first);
    high.push_back(box.second);
  }
  tree_ = BoxTree(low, high);
}

PlacedFace Patch::placed(const Triangle& f) const {
  const std::vector<Vec3>& points = surface_.mesh.vertices;
  return {f, {points[f[0]], points[f[1]], points[f[2]]}};
}

PlacedFace Patch::placed(const Triangle& f, const Step& step) const {
  PlacedFace face{f, {}};
  for (std::size_t k = 0; k < 3; ++k)
    face.points[k] = f[k] == step.vertex ? step.at.position : surface_.mesh.vertices[f[k]];
  return face;
}

std::vector<Index> Patch::faces_of(const MeshEdge& e) const {
  std::vector<Index> both;
  for (const Index f : faces_at_[e.a]) {
    if (has(surface_.mesh.faces[f], e.b)) both.push_back(f);
  }
  return both;
}

// The vertex together with its neighbours, ascending.
std::vector<Index> Patch::around(Index v) const {
  std::vector<Index> vertices;
  for (const Index f : faces_at_[v])
    vertices.insert(vertices.end(), surface_.mesh.faces[f].begin(), surface_.mesh.faces[f].end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

std::array<Index, 2> Patch::opposite(const MeshEdge& e) const {
  const std::vector<Index> both = faces_of(e);
  const auto other = [&](const Triangle& f) {
    return *std::find_if(f.begin(), f.end(), [&](Index v) { return v != e.a && v != e.b; });
  };
  return {other(surface_.mesh.faces[both[0]]), other(surface_.mesh.faces[both[1]])};
}

Patch::Step Patch::splitting(const MeshEdge& e, const BoundaryPoint& at) const {
  Step step{static_cast<Index>(surface_.mesh.vertices.size()), at, faces_of(e), {}};
  for (const Index f : step.gone) {
    for (const Index end : {e.a, e.b}) step.faces.push_back(replaced(surface_.mesh.faces[f], end, step.vertex));
  }
  return step;
}

Patch::Step Patch::moving(Index v, const BoundaryPoint& at) const {
  Step step{v, at, faces_at_[v], {}};
  for (const Index f : step.gone) step.faces.push_back(surface_.mesh.faces[f]);
  return step;
}

Patch::Step Patch::collapsing(const MeshEdge& e, const BoundaryPoint& at) const {
  Step step{e.b, at, faces_at_[e.b], {}};
  for (const Index f : faces_at_[e.a]) {
    if (!has(surface_.mesh.faces[f], e.b)) step.gone.push_back(f);
  }
  for (const Index f : step.gone) {
    const Triangle& face = surface_.mesh.faces[f];
    if (!has(face, e.a) || !has(face, e.b)) step.faces.push_back(replaced(face, e.a, e.b));
  }
  return step;
}

Patch::Step Patch::flipping(const MeshEdge& e) const {
  Step step{kNone, {}, faces_of(e), {}};
  const auto [c, d] = opposite(e);
  for (const auto& [f, near, far] : {std::tuple(step.gone[0], c, d), std::tuple(step.gone[1], d, c)}) {
    Triangle face = surface_.mesh.faces[f];
    const auto at = static_cast<std::size_t>(std::find(face.begin(), face.end(), near) - face.begin());
    face[(at + 2) % 3] = far;  // each of the two faces gives up one end
    step.faces.push_back(face);
  }
  return step;
}

// Whether its ends share no neighbours but the opposite corners of its faces, and neither lies at an opening.
bool Patch::may_collapse(const MeshEdge& e) const {
  if (!is_inner(e.a) || !is_inner(e.b)) return false;
  const std::vector<Index> at_a = around(e.a), at_b = around(e.b);
  std::vector<Index> common;
  std::set_intersection(at_a.begin(), at_a.end(), at_b.begin(), at_b.end(), std::back_inserter(common));
  return common.size() == 4;
}

bool Patch::may_flip(const MeshEdge& e) const {
  const auto [c, d] = opposite(e);
  return faces_of({c, d}).empty();
}

Index Patch::take_best(const std::vector<Step>& steps, double worst) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < steps.size(); ++i) order.emplace_back(worst_skewness(steps[i]), i);
  std::sort(order.begin(), order.end());
  for (const auto& [leaves, i] : order) {
    if (leaves > worst) break;
    if (!may_take(steps[i])) continue;
    take(steps[i]);
    return steps[i].vertex != kNone ? steps[i].vertex : steps[i].faces[0][0];
  }
  return kNone;
}

double Patch::worst_skewness(const Step& step) const {
  double worst = 0;
  for (const Triangle& f : step.faces) worst = std::max(worst, skewness(placed(f, step)));
  return worst;
}

bool Patch::may_take(const Step& step) const {
  std::vector<PlacedFace> faces;
  for (const Triangle& f : step.faces) faces.push_back(placed(f, step));
  if (std::any_of(faces.begin(), faces.end(), is_degenerate)) return false;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (intersect(faces[i], faces[j])) return false;
    }
  }
  return std::none_of(faces.begin(), faces.end(), [&](const PlacedFace& f) { return is_crossed(f, step.gone); });
}

bool Patch::is_crossed(const PlacedFace& face, const std::vector<Index>& gone) const {
  const auto crosses = [&](Index f) {
    const Triangle& other = surface_.mesh.faces[f];
    return other != kDead && std::find(gone.begin(), gone.end(), f) == gone.end() && intersect(face, placed(other));
  };
  if (std::any_of(latest_.begin(), latest_.end(), crosses)) return true;
  bool crossed = false;
  const auto [low, high] = box_of(face);
  tree_.visit_overlapping(low, high, [&](Index f) { crossed = crossed || (!changed_[f] && crosses(f)); });
  return crossed;
}

void Patch::place(const Step& step) {
  if (step.vertex == kNone) return;
  if (step.vertex == surface_.mesh.vertices.size()) {
    surface_.mesh.vertices.emplace_back();
    surface_.binding.emplace_back();
    surface_.radius.emplace_back();
    faces_at_.emplace_back();
  }
  const FieldSample& sample = step.at.sample;
  surface_.mesh.vertices[step.vertex] = step.at.position;
  surface_.binding[step.vertex] = {sample.cone, sample.t};
  surface_.radius[step.vertex] = field_.radius_at(sample.cone, sample.t);
}

void Patch::take(const Step& step) {
  place(step);
  std::vector<Triangle>& faces = surface_.mesh.faces;
  for (const Index f : step.gone) {
    for (const Index v : faces[f]) std::erase(faces_at_[v], f);
    faces[f] = kDead;
    if (!changed_[f]) latest_.push_back(f);
    changed_[f] = 1;
  }
  for (std::size_t i = 0; i < step.faces.size(); ++i) {
    const Index f = i < step.gone.size() ? step.gone[i] : static_cast<Index>(faces.size());
    if (f == faces.size()) {
      faces.emplace_back();
      changed_.push_back(1);
      latest_.push_back(f);
    }
    faces[f] = step.faces[i];
    for (const Index v : step.faces[i]) faces_at_[v].push_back(f);
  }
}

void Patch::mend(double worst) {
  bool any = true;
  for (int round = 0; any && round < kMendRounds; ++round) {
    any = false;
    const std::vector<Index> faces = latest_;
    for (const Index f : faces) {
      const Triangle& face = surface_.mesh.faces[f];
      if (face != kDead && skewness(placed(face)) > worst) any = mend_face(f, worst) || any;
    }
  }
}

bool Patch::mend_face(Index f, double worst) {
  const Triangle face = surface_.mesh.faces[f];
  std::vector<Step> steps;
  for (std::size_t k = 0; k < 3; ++k) {
    const MeshEdge e{face[k], face[(k + 1) % 3]};
    if (!is_inner(e)) continue;
    if (may_flip(e)) steps.push_back(flipping(e));
    if (!may_collapse(e)) continue;
    for (const Index v : {e.a, e.b}) {
      const Vec3& p = surface_.mesh.vertices[v];
      steps.push_back(collapsing(e, {p, field_.sample(p, surface_.binding[v].segment)}));
    }
  }
  return take_best(steps, worst) != kNone;
}

std::vector<Index> Patch::remove_dead() {
  TriMesh& mesh = surface_.mesh;
  std::vector<Index> number(mesh.vertices.size(), kNone);
  Index count = 0;
  for (Index v = 0; v < number.size(); ++v) {
    if (faces_at_[v].empty()) continue;
    mesh.vertices[count] = mesh.vertices[v];
    surface_.binding[count] = surface_.binding[v];
    surface_.radius[count] = surface_.radius[v];
    number[v] = count++;
  }
  mesh.vertices.resize(count);
  surface_.binding.resize(count);
  surface_.radius.resize(count);
  std::erase(mesh.faces, kDead);
  for (Triangle& f : mesh.faces) {
    for (Index& v : f) v = number[v];
  }
  for (Opening& opening : surface_.openings) {
    for (Index& v : opening.ring) v = number[v];
  }
  return number;
}

}  // namespace vmesh

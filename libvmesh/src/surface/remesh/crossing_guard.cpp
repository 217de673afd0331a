#include "surface/remesh/crossing_guard.h"

#include <algorithm>

namespace vmesh {
namespace {

constexpr std::size_t kMostLatest = 32;  // faces that are looked at one by one

std::pair<Vec3, Vec3> box_of(const PlacedFace& f) {
  const auto& [a, b, c] = f.points;
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

}  // namespace

CrossingGuard::CrossingGuard(const Mesh& mesh, std::function<bool(Vertex)> is_lid)
    : mesh_(mesh), is_lid_(std::move(is_lid)) {
  add_layer({mesh.faces().begin(), mesh.faces().end()});
}

void CrossingGuard::add_layer(std::vector<Face> faces) {
  while (!layers_.empty() && layers_.back().faces.size() < 2 * faces.size()) {
    faces.insert(faces.end(), layers_.back().faces.begin(), layers_.back().faces.end());
    layers_.pop_back();
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  std::erase_if(faces, [&](Face f) { return f.idx() >= mesh_.num_faces() || mesh_.is_removed(f) || is_lid(f); });
  std::vector<Vec3> low, high;
  for (const Face f : faces) {
    const auto box = box_of(placed(f));
    low.push_back(box.first);
    high.push_back(box.second);
  }
  BoxTree tree(low, high);
  layers_.push_back({std::move(faces), std::move(tree)});
}

bool CrossingGuard::is_lid(Face f) const {
  for (const Vertex v : mesh_.vertices_around_face(mesh_.halfedge(f))) {
    if (is_lid_(v)) return true;
  }
  return false;
}

PlacedFace CrossingGuard::placed(Face f) const {
  const Halfedge h = mesh_.halfedge(f);
  const Vertex a = mesh_.source(h), b = mesh_.target(h), c = mesh_.target(mesh_.next(h));
  return {{a.idx(), b.idx(), c.idx()}, {mesh_.point(a), mesh_.point(b), mesh_.point(c)}};
}

void CrossingGuard::insert(Face f) {
  latest_.push_back(f);
  if (latest_.size() < kMostLatest) return;
  add_layer(std::move(latest_));
  latest_.clear();
}

void CrossingGuard::touch(Vertex v) {
  for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) {
    if (f != Mesh::null_face()) insert(f);
  }
}

bool CrossingGuard::clear(const std::vector<PlacedFace>& faces, const std::vector<Face>& gone) const {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (is_degenerate(faces[i])) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (intersect(faces[i], faces[j])) return false;
    }
  }
  return std::none_of(faces.begin(), faces.end(), [&](const PlacedFace& face) { return is_crossed(face, gone); });
}

bool CrossingGuard::is_crossed(const PlacedFace& face, const std::vector<Face>& gone) const {
  const auto [low, high] = box_of(face);
  bool crossed = false;
  const auto look_at = [&, low_corner = low, high_corner = high](Face f) {
    if (crossed || f.idx() >= mesh_.num_faces() || mesh_.is_removed(f)) return;
    const PlacedFace other = placed(f);
    const auto [other_low, other_high] = box_of(other);
    if ((other_low.array() > high_corner.array()).any() || (low_corner.array() > other_high.array()).any()) return;
    if (std::find(gone.begin(), gone.end(), f) != gone.end() || is_lid(f) || is_degenerate(other)) return;
    crossed = intersect(face, other);
  };
  for (const Face f : latest_) look_at(f);
  for (const Layer& layer : layers_) {
    if (crossed) break;
    layer.tree.visit_overlapping(low, high, [&](Index i) { look_at(layer.faces[i]); });
  }
  return crossed;
}

bool CrossingGuard::may_move(Vertex v, const Vec3& p) const {
  std::vector<PlacedFace> faces;
  std::vector<Face> gone;
  for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) {
    gone.push_back(f);
    if (is_lid(f)) continue;
    faces.push_back(placed(f));
    for (int i = 0; i < 3; ++i) {
      if (faces.back().vertices[i] == v.idx()) faces.back().points[i] = p;
    }
  }
  return clear(faces, gone);
}

bool CrossingGuard::may_collapse(Vertex a, Vertex b, const Vec3& p) const {
  std::vector<PlacedFace> faces;
  std::vector<Face> gone;
  for (const Vertex v : {a, b}) {
    for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) {
      gone.push_back(f);
      PlacedFace face = placed(f);
      int ends = 0;
      for (int i = 0; i < 3; ++i) {
        if (face.vertices[i] != a.idx() && face.vertices[i] != b.idx()) continue;
        face.vertices[i] = a.idx();
        face.points[i] = p;
        ++ends;
      }
      if (ends == 1 && !is_lid(f)) faces.push_back(face);
    }
  }
  return clear(faces, gone);
}

bool CrossingGuard::may_flip(Halfedge h) const {
  const Halfedge o = mesh_.opposite(h);
  const Vertex a = mesh_.source(h), b = mesh_.target(h);
  const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
  const auto face = [&](Vertex x, Vertex y, Vertex z) {
    return PlacedFace{{x.idx(), y.idx(), z.idx()}, {mesh_.point(x), mesh_.point(y), mesh_.point(z)}};
  };
  return clear({face(c, d, b), face(d, c, a)}, {mesh_.face(h), mesh_.face(o)});
}

}  // namespace vmesh

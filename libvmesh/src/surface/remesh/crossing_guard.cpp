#include "surface/remesh/crossing_guard.h"

#include <algorithm>

namespace vmesh {
namespace {

constexpr std::size_t kMostLatest = 32;  // faces outside any layer, tested one by one; idle 22 to 45
// Each part has its own box: the box of a whole oblique axis would be mostly empty; idle 6 to 11.
constexpr int kPartsOfLine = 8;
// Derived: relative rounding of an interpolated point, a few units in the last place.
constexpr double kRounding = 1e-15;
// Margin around a face in its box, relative to the diagonal of the face's own bounds; idle 0.17 to 0.35.
constexpr double kRoom = 0.25;

std::pair<Vec3, Vec3> box_of(const PlacedFace& f) {
  const auto& [a, b, c] = f.points;
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

bool are_apart(const Vec3& low, const Vec3& high, const Vec3& other_low, const Vec3& other_high) {
  return (low.array() > other_high.array()).any() || (other_low.array() > high.array()).any();
}

}  // namespace

CrossingGuard::CrossingGuard(const Mesh& mesh, std::function<bool(Vertex)> is_lid, std::vector<AxisLine> axes)
    : mesh_(mesh), is_lid_(std::move(is_lid)), axes_(std::move(axes)) {
  std::vector<Vec3> low, high;
  for (const auto& [from, to] : axes_) {
    for (int i = 0; i < kPartsOfLine; ++i) {
      const double t0 = double(i) / kPartsOfLine, t1 = double(i + 1) / kPartsOfLine;
      const Vec3 begin = (1 - t0) * from + t0 * to, end = (1 - t1) * from + t1 * to;
      const double rounding = kRounding * (from.cwiseAbs() + to.cwiseAbs()).maxCoeff();
      low.push_back(begin.cwiseMin(end).array() - rounding);
      high.push_back(begin.cwiseMax(end).array() + rounding);
    }
  }
  axis_tree_ = BoxTree(low, high);
  for (const Face f : mesh.faces()) insert(f);
}

// Whether the entry is still the face's box.
bool CrossingGuard::is_current(const Entry& entry) const {
  return box_[entry.face.idx()].number == entry.number && entry.face.idx() < mesh_.num_faces() &&
         !mesh_.is_removed(entry.face);
}

void CrossingGuard::add_layer(std::vector<Entry> entries) {
  while (!layers_.empty() && layers_.back().entries.size() < 2 * entries.size()) {
    const std::vector<Entry>& last = layers_.back().entries;
    entries.insert(entries.end(), last.begin(), last.end());
    layers_.pop_back();
  }
  std::erase_if(entries, [&](const Entry& entry) { return !is_current(entry); });
  std::vector<Vec3> low, high;
  for (const Entry& entry : entries) {
    low.push_back(box_[entry.face.idx()].low);
    high.push_back(box_[entry.face.idx()].high);
  }
  BoxTree tree(low, high);
  layers_.push_back({std::move(entries), std::move(tree)});
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
  if (is_lid(f)) return;
  if (f.idx() >= box_.size()) box_.resize(f.idx() + 1);
  Box& box = box_[f.idx()];
  const auto [low, high] = box_of(placed(f));
  if ((box.low.array() <= low.array()).all() && (high.array() <= box.high.array()).all()) return;
  const double room = kRoom * (high - low).norm();
  box = {low.array() - room, high.array() + room, next_number_++};
  latest_.push_back({f, box.number});
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
  return !cross_axes(faces, gone) && !cross_others(faces, gone);
}

bool CrossingGuard::cross_axes(const std::vector<PlacedFace>& faces, const std::vector<Face>& gone) const {
  const auto meets = [&](const PlacedFace& face, Index axis) {
    return meets_segment(face, axes_[axis][0], axes_[axis][1]);
  };
  return std::any_of(faces.begin(), faces.end(), [&](const PlacedFace& face) {
    const auto [low, high] = box_of(face);
    bool crossed = false;
    axis_tree_.visit_overlapping(low, high, [&](Index part) {
      const Index axis = part / kPartsOfLine;
      if (crossed || !meets(face, axis)) return;
      crossed = std::none_of(gone.begin(), gone.end(), [&](Face f) {
        const PlacedFace before = placed(f);
        return !is_degenerate(before) && meets(before, axis);
      });
    });
    return crossed;
  });
}

bool CrossingGuard::cross_others(const std::vector<PlacedFace>& faces, const std::vector<Face>& gone) const {
  if (faces.empty()) return false;
  auto [low, high] = box_of(faces.front());
  for (const PlacedFace& face : faces) {
    const auto box = box_of(face);
    low = low.cwiseMin(box.first);
    high = high.cwiseMax(box.second);
  }
  bool crossed = false;
  const auto look_at = [&](const Entry& entry) {
    if (crossed || !is_current(entry)) return;
    const Box& room = box_[entry.face.idx()];
    if (are_apart(room.low, room.high, low, high)) return;
    const PlacedFace other = placed(entry.face);
    const auto other_box = box_of(other);
    const Vec3 &other_low = other_box.first, &other_high = other_box.second;
    if (are_apart(other_low, other_high, low, high) || std::find(gone.begin(), gone.end(), entry.face) != gone.end() ||
        is_degenerate(other))
      return;
    crossed = std::any_of(faces.begin(), faces.end(), [&](const PlacedFace& face) {
      const auto box = box_of(face);
      return !are_apart(other_low, other_high, box.first, box.second) && intersect(face, other);
    });
  };
  for (const Entry& entry : latest_) look_at(entry);
  for (const Layer& layer : layers_) {
    if (crossed) break;
    layer.tree.visit_overlapping(low, high, [&](Index i) { look_at(layer.entries[i]); });
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

#include "vmesh/edit/face_table.h"

#include <algorithm>

namespace vmesh {

FaceTable::FaceTable(std::vector<Triangle> faces, std::size_t vertices) : faces_(std::move(faces)), around_(vertices) {
  for (Index f = 0; f < faces_.size(); ++f) {
    for (const Index v : faces_[f]) around_[v].push_back(f);
  }
}

void FaceTable::attach(Index f) {
  for (const Index v : faces_[f]) around_[v].insert(std::lower_bound(around_[v].begin(), around_[v].end(), f), f);
}

void FaceTable::detach(Index f) {
  for (const Index v : faces_[f]) around_[v].erase(std::lower_bound(around_[v].begin(), around_[v].end(), f));
}

std::size_t FaceTable::vertex_count() const {
  return static_cast<std::size_t>(
      std::count_if(around_.begin(), around_.end(), [](const auto& faces) { return !faces.empty(); }));
}

void FaceTable::neighbours(Index v, std::vector<Index>& result) const {
  result.clear();
  for (const Index f : around_[v]) {
    for (const Index w : faces_[f]) {
      if (w != v) result.push_back(w);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
}

bool FaceTable::are_neighbours(Index a, Index b) const {
  return std::any_of(around_[a].begin(), around_[a].end(), [&](Index f) { return has_corner(faces_[f], b); });
}

Index FaceTable::face_of(Index a, Index b) const {
  for (const Index f : around_[a]) {
    const Triangle& t = faces_[f];
    if ((t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b)) return f;
  }
  return kNone;
}

Index FaceTable::apex(const Triangle& face, const MeshEdge& e) {
  for (const Index v : face) {
    if (v != e.a && v != e.b) return v;
  }
  return kNone;
}

std::array<Index, 2> FaceTable::opposite(const MeshEdge& e) const {
  return {apex(faces_[face_of(e.a, e.b)], e), apex(faces_[face_of(e.b, e.a)], e)};
}

bool FaceTable::is_inner(Index v) const {
  std::vector<Index> near;
  neighbours(v, near);
  return near.size() == around_[v].size();
}

std::vector<MeshEdge> FaceTable::edges() const {
  std::vector<MeshEdge> result;
  for (Index f = 0; f < faces_.size(); ++f) {
    if (!has_face(f)) continue;
    for (int i = 0; i < 3; ++i) {
      const Index a = faces_[f][i], b = faces_[f][(i + 1) % 3];
      if (a < b || face_of(b, a) == kNone) result.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  return result;
}

bool FaceTable::may_flip(const MeshEdge& e) const {
  const auto [c, d] = opposite(e);
  return c != d && !are_neighbours(c, d);
}

bool FaceTable::may_collapse(const MeshEdge& e) const {
  if (!is_inner(e) || !is_inner(e.a) || !is_inner(e.b)) return false;
  std::vector<Index> near_a, near_b, common;
  neighbours(e.a, near_a);
  neighbours(e.b, near_b);
  std::set_intersection(near_a.begin(), near_a.end(), near_b.begin(), near_b.end(), std::back_inserter(common));
  return common.size() == 2 &&
         std::all_of(common.begin(), common.end(), [&](Index v) { return around_[v].size() > 3; }) &&
         near_a.size() + near_b.size() > 6;  // not a tetrahedron
}

void FaceTable::set_face(Index f, const Triangle& face) {
  if (is_open()) written_.emplace_back(f, faces_[f]);
  if (has_face(f)) detach(f);
  faces_[f] = face;
  if (has_face(f)) attach(f);
}

Index FaceTable::add_face(const Triangle& face) {
  faces_.push_back(kRemoved);
  set_face(static_cast<Index>(faces_.size() - 1), face);
  return static_cast<Index>(faces_.size() - 1);
}

std::vector<Index> FaceTable::pack_faces() {
  std::vector<Index> number(around_.size(), kNone);
  Index count = 0;
  for (Index v = 0; v < number.size(); ++v) {
    if (has_vertex(v)) number[v] = count++;
  }
  std::erase(faces_, kRemoved);
  for (Triangle& face : faces_) {
    for (Index& v : face) v = number[v];
  }
  *this = FaceTable(std::move(faces_), count);
  return number;
}

FaceTable::FaceMark FaceTable::open() {
  if (open_++ == 0) written_.clear();
  return {written_.size(), faces_.size(), around_.size()};
}

void FaceTable::undo(const FaceMark& mark) {
  for (; written_.size() > mark.written; written_.pop_back()) {
    const auto& [f, face] = written_.back();
    if (has_face(f)) detach(f);
    faces_[f] = face;
    if (has_face(f)) attach(f);
  }
  faces_.resize(mark.faces);
  around_.resize(mark.vertices);
}

std::vector<Index> FaceTable::faces_since(const FaceMark& mark) const {
  std::vector<Index> faces;
  for (std::size_t i = mark.written; i < written_.size(); ++i) faces.push_back(written_[i].first);
  return faces;
}

}  // namespace vmesh

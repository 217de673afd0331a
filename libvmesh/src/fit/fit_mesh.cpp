#include "fit/fit_mesh.h"

#include <algorithm>

namespace vmesh {

FitMesh::FitMesh(const TriMesh& mesh, std::vector<Vertex> given)
    : vertices(std::move(given)), faces(mesh.faces), around_(vertices.size()), vertex_count_(vertices.size()) {
  for (Index f = 0; f < faces.size(); ++f) attach(f);
}

void FitMesh::attach(Index f) {
  for (const Index v : faces[f]) around_[v].insert(std::lower_bound(around_[v].begin(), around_[v].end(), f), f);
}

void FitMesh::detach(Index f) {
  for (const Index v : faces[f]) around_[v].erase(std::lower_bound(around_[v].begin(), around_[v].end(), f));
}

Vec3 FitMesh::area_normal(Index f) const {
  const auto [a, b, c] = corners(f);
  return (b - a).cross(c - a);
}

Vec3 FitMesh::unit_normal(Index f) const {
  const Vec3 normal = area_normal(f);
  const double norm = normal.norm();
  return norm > 0 ? Vec3(normal / norm) : Vec3(Vec3::Zero());
}

Vec3 FitMesh::vertex_normal(Index v) const {
  Vec3 normal = Vec3::Zero();
  for (const Index f : around_[v]) normal += area_normal(f);
  const double norm = normal.norm();
  return norm > 0 ? Vec3(normal / norm) : Vec3(Vec3::Zero());
}

void FitMesh::neighbours(Index v, std::vector<Index>& result) const {
  result.clear();
  for (const Index f : around_[v]) {
    for (const Index w : faces[f]) {
      if (w != v) result.push_back(w);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
}

bool FitMesh::are_neighbours(Index a, Index b) const {
  return std::any_of(around_[a].begin(), around_[a].end(),
                     [&](Index f) { return std::find(faces[f].begin(), faces[f].end(), b) != faces[f].end(); });
}

Index FitMesh::face_of(Index a, Index b) const {
  for (const Index f : around_[a]) {
    const Triangle& t = faces[f];
    if ((t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b)) return f;
  }
  return kNone;
}

Index FitMesh::apex(const Triangle& face, Index a, Index b) {
  for (const Index v : face) {
    if (v != a && v != b) return v;
  }
  return kNone;
}

double FitMesh::mean_edge(Index v) const {
  double sum = 0;
  for (const Index f : around_[v]) {
    for (const Index w : faces[f]) {
      if (w != v) sum += (position(w) - position(v)).norm();
    }
  }
  return around_[v].empty() ? 0 : sum / static_cast<double>(2 * around_[v].size());
}

std::vector<std::array<Index, 2>> FitMesh::edges() const {
  std::vector<std::array<Index, 2>> result;
  for (Index f = 0; f < faces.size(); ++f) {
    if (!has_face(f)) continue;
    for (int i = 0; i < 3; ++i) {
      const Index a = faces[f][i], b = faces[f][(i + 1) % 3];
      if (a < b || face_of(b, a) == kNone) result.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  return result;
}

void FitMesh::flip(Index a, Index b) {
  const Index f = face_of(a, b), g = face_of(b, a);
  const Index c = apex(faces[f], a, b), d = apex(faces[g], a, b);
  detach(f);
  detach(g);
  faces[f] = {c, a, d};
  faces[g] = {d, b, c};
  attach(f);
  attach(g);
}

Index FitMesh::split(Index a, Index b, const Vertex& middle) {
  const auto m = static_cast<Index>(vertices.size());
  vertices.push_back(middle);
  around_.emplace_back();
  ++vertex_count_;
  const std::array<Index, 2> sides{face_of(a, b), face_of(b, a)};
  for (const Index f : sides) {
    detach(f);
    Triangle other = faces[f];
    std::replace(faces[f].begin(), faces[f].end(), b, m);
    std::replace(other.begin(), other.end(), a, m);
    const auto g = static_cast<Index>(faces.size());
    faces.push_back(other);
    attach(f);
    attach(g);
  }
  return m;
}

bool FitMesh::may_collapse(Index a, Index b) const {
  const Index f = face_of(a, b), g = face_of(b, a);
  if (f == kNone || g == kNone || on_border(a) || on_border(b)) return false;
  std::vector<Index> near_a, near_b, common;
  neighbours(a, near_a);
  neighbours(b, near_b);
  std::set_intersection(near_a.begin(), near_a.end(), near_b.begin(), near_b.end(), std::back_inserter(common));
  if (common.size() != 2) return false;
  return std::all_of(common.begin(), common.end(), [&](Index v) { return around_[v].size() > 3; }) &&
         near_a.size() + near_b.size() > 6;  // not a tetrahedron
}

void FitMesh::collapse(Index a, Index b) {
  for (const Index f : {face_of(a, b), face_of(b, a)}) {
    detach(f);
    faces[f] = {kNone, kNone, kNone};
  }
  const std::vector<Index> moved = around_[b];
  for (const Index f : moved) {
    detach(f);
    std::replace(faces[f].begin(), faces[f].end(), b, a);
    attach(f);
  }
  --vertex_count_;
}

std::vector<Index> FitMesh::pack() {
  std::vector<Index> number(vertices.size(), kNone);
  std::vector<Vertex> kept;
  kept.reserve(vertex_count_);
  for (Index v = 0; v < vertices.size(); ++v) {
    if (!has_vertex(v)) continue;
    number[v] = static_cast<Index>(kept.size());
    kept.push_back(vertices[v]);
  }
  std::erase_if(faces, [](const Triangle& face) { return face[0] == kNone; });
  for (Triangle& face : faces) {
    for (Index& v : face) v = number[v];
  }
  vertices = std::move(kept);
  around_.assign(vertices.size(), {});
  for (Index f = 0; f < faces.size(); ++f) {
    for (const Index v : faces[f]) around_[v].push_back(f);
  }
  return number;
}

TriMesh FitMesh::tri_mesh() const {
  TriMesh mesh;
  mesh.vertices.reserve(vertices.size());
  for (const Vertex& v : vertices) mesh.vertices.push_back(v.position);
  mesh.faces = faces;
  return mesh;
}

}  // namespace vmesh

#include "surface/junction/docking.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace vmesh {
namespace {

constexpr std::size_t kShortestRim = 5;  // vertices; safe 4 to 7
constexpr double kNearestCut = 0.1;      // of an edge: least distance of a cut from its ends; safe 0.07 to 0.14

}  // namespace

DiscCutter::DiscCutter(std::vector<Vec3> vertices, std::vector<Triangle> faces)
    : source_(vertices.size()), faces_of_(vertices.size()), removed_vertex_(vertices.size(), 0) {
  vertices_ = std::move(vertices);
  std::iota(source_.begin(), source_.end(), Index{0});
  for (const Triangle& face : faces) add_face(face);
}

std::vector<Index> DiscCutter::cut(const Vec3& center, const Vec3& normal, const std::vector<Index>& own,
                                   double shortest) {
  const Index apex = farthest(normal, own);
  if (apex == kNone) return open_window(center);
  const double at_plane = center.dot(normal);
  const auto height = [&](const Vec3& p) { return p.dot(normal) - at_plane; };
  const auto region = region_above(apex, height, own);
  std::vector<Index> rim = cut_off(is_disc(region) ? region : std::vector<Index>{apex}, height);
  collapse_short_edges(rim, shortest);
  return rim;
}

Index DiscCutter::farthest(const Vec3& normal, const std::vector<Index>& own) const {
  Index apex = kNone;
  for (const Index v : own) {
    if (removed_vertex_[v]) continue;
    if (apex == kNone || vertices_[v].dot(normal) > vertices_[apex].dot(normal)) apex = v;
  }
  return apex;
}

std::vector<Index> DiscCutter::region_above(Index apex, const Height& height, const std::vector<Index>& own) const {
  std::vector<char> open(vertices_.size(), 0);  // allowed to join, and has not joined yet
  for (const Index v : own) open[v] = !removed_vertex_[v] && height(vertices_[v]) > 0;
  std::vector<Index> region = {apex};
  open[apex] = 0;
  for (std::size_t i = 0; i < region.size(); ++i) {
    for (const Index f : faces_of_[region[i]]) {
      if (removed_face_[f]) continue;
      for (const Index v : faces_[f]) {
        if (!open[v]) continue;
        open[v] = 0;
        region.push_back(v);
      }
    }
  }
  return region;
}

std::vector<Index> DiscCutter::faces_around(const std::vector<Index>& region) const {
  std::vector<Index> faces;
  for (const Index v : region) {
    for (const Index f : faces_of_[v]) {
      if (!removed_face_[f]) faces.push_back(f);
    }
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

// A connected region that touches no rim is a disc if its Euler characteristic is 1.
bool DiscCutter::is_disc(const std::vector<Index>& region) const {
  const std::set<Index> inside(region.begin(), region.end());
  std::size_t half_edges = 0, faces = 0;
  for (const Index f : faces_around(region)) {
    const auto& [a, b, c] = faces_[f];
    const int count = static_cast<int>(inside.count(a) + inside.count(b) + inside.count(c));
    half_edges += count == 3 ? 3 : count == 2 ? 1 : 0;
    faces += count == 3;
  }
  return region.size() + faces == half_edges / 2 + 1;
}

std::vector<Index> DiscCutter::cut_off(const std::vector<Index>& region, const Height& height) {
  const std::set<Index> inside(region.begin(), region.end());
  std::map<std::pair<Index, Index>, Index> cuts;  // keyed by the edge's inner and outer end
  const auto cut = [&](Index in, Index out) {
    const auto [it, is_new] = cuts.try_emplace({in, out}, kNone);
    if (is_new) {
      const double high = height(vertices_[in]), low = height(vertices_[out]);
      const double t = low < 0 ? std::clamp(high / (high - low), kNearestCut, 1 - kNearestCut) : 0.5;
      it->second = add_vertex((1 - t) * vertices_[in] + t * vertices_[out], source_[t < 0.5 ? in : out]);
    }
    return it->second;
  };
  std::map<Index, Index> next;  // along the rim
  for (const Index f : faces_around(region)) {
    removed_face_[f] = 1;
    Triangle face = faces_[f];
    const auto is_inside = [&](int i) { return inside.count(face[i]) > 0; };
    const int count = is_inside(0) + is_inside(1) + is_inside(2);
    if (count == 3) continue;
    while (is_inside(0) != (count == 1) || is_inside(1) != (count == 2))
      std::rotate(face.begin(), face.begin() + 1, face.end());
    const auto& [a, b, c] = face;
    if (count == 1) {  // a is inside
      const Index p = cut(a, b), q = cut(a, c);
      next[p] = q;
      add_quad(p, b, c, q);
    } else {  // b and c are inside
      const Index p = cut(c, a), q = cut(b, a);
      next[p] = q;
      add_face({a, q, p});
    }
  }
  for (const Index v : region) removed_vertex_[v] = 1;
  std::vector<Index> rim = {next.begin()->first};
  for (Index v = next.begin()->second; v != rim.front(); v = next.at(v)) rim.push_back(v);
  return rim;
}

void DiscCutter::collapse_short_edges(std::vector<Index>& rim, double shortest) {
  for (std::size_t i = 0; i < rim.size() && rim.size() > kShortestRim;) {
    const std::size_t next = (i + 1) % rim.size();
    if ((vertices_[rim[i]] - vertices_[rim[next]]).norm() >= shortest || !collapsible(rim[next], rim[i])) {
      ++i;
      continue;
    }
    collapse(rim[next], rim[i]);
    rim.erase(rim.begin() + static_cast<std::ptrdiff_t>(next));
  }
}

// The face at the border edge provides the only common neighbour, and each vertex keeps at least one face.
bool DiscCutter::collapsible(Index v, Index into) const {
  const auto a = neighbours(v), b = neighbours(into);
  std::vector<Index> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return common.size() == 1 && a.size() > 2 && b.size() > 2;
}

void DiscCutter::collapse(Index v, Index into) {
  for (const Index f : faces_of_[v]) {
    if (removed_face_[f]) continue;
    if (std::count(faces_[f].begin(), faces_[f].end(), into)) {
      removed_face_[f] = 1;
    } else {
      std::replace(faces_[f].begin(), faces_[f].end(), v, into);
      faces_of_[into].push_back(f);
    }
  }
  removed_vertex_[v] = 1;
}

std::vector<Index> DiscCutter::neighbours(Index v) const {
  std::vector<Index> all;
  for (const Index f : faces_of_[v]) {
    if (removed_face_[f]) continue;
    for (const Index w : faces_[f]) {
      if (w != v) all.push_back(w);
    }
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

Index DiscCutter::add_vertex(const Vec3& position, Index source) {
  vertices_.push_back(position);
  source_.push_back(source);
  faces_of_.emplace_back();
  removed_vertex_.push_back(0);
  return static_cast<Index>(vertices_.size() - 1);
}

void DiscCutter::add_face(const Triangle& face) {
  for (const Index v : face) faces_of_[v].push_back(static_cast<Index>(faces_.size()));
  faces_.push_back(face);
  removed_face_.push_back(0);
}

// Splits the quad along its shorter diagonal.
void DiscCutter::add_quad(Index a, Index b, Index c, Index d) {
  if ((vertices_[a] - vertices_[c]).squaredNorm() < (vertices_[b] - vertices_[d]).squaredNorm()) {
    add_face({a, b, c});
    add_face({a, c, d});
  } else {
    add_face({a, b, d});
    add_face({b, c, d});
  }
}

std::vector<Index> DiscCutter::open_window(const Vec3& near) {
  const auto center = [&](Index f) -> Vec3 {
    return (vertices_[faces_[f][0]] + vertices_[faces_[f][1]] + vertices_[faces_[f][2]]) / 3;
  };
  Index best = kNone;
  for (Index f = 0; f < faces_.size(); ++f) {
    if (removed_face_[f]) continue;
    if (best == kNone || (center(f) - near).squaredNorm() < (center(best) - near).squaredNorm()) best = f;
  }
  const Triangle outer = faces_[best];
  const Vec3 middle = center(best);
  std::vector<Index> window;
  for (const Index v : outer) window.push_back(add_vertex(0.5 * (vertices_[v] + middle), source_[v]));
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    add_quad(outer[i], outer[next], window[next], window[i]);
  }
  removed_face_[best] = 1;
  return window;
}

std::vector<Triangle> DiscCutter::rest() const {
  std::vector<Triangle> result;
  for (Index f = 0; f < faces_.size(); ++f) {
    if (!removed_face_[f]) result.push_back(faces_[f]);
  }
  return result;
}

}  // namespace vmesh

#include "surface/junction/disc_cutter.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace vmesh {
namespace {

constexpr std::size_t kShortestRim = 5;  // vertices; safe 4 to 7
constexpr double kNearestCut = 0.1;      // of an edge: least distance of a cut from its ends; safe 0.07 to 0.14

}  // namespace

DiscCutter::DiscCutter(const std::vector<Vec3>& positions, std::vector<Triangle> faces) {
  std::vector<Vertex> vertices;
  for (const Vec3& p : positions) vertices.push_back({p, static_cast<Index>(vertices.size())});
  mesh_ = {std::move(faces), std::move(vertices)};
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
    if (!mesh_.has_vertex(v)) continue;
    if (apex == kNone || mesh_.position(v).dot(normal) > mesh_.position(apex).dot(normal)) apex = v;
  }
  return apex;
}

std::vector<Index> DiscCutter::region_above(Index apex, const Height& height, const std::vector<Index>& own) const {
  open_.resize(mesh_.vertices().size(), 0);  // allowed to join, and has not joined yet
  for (const Index v : own) open_[v] = mesh_.has_vertex(v) && height(mesh_.position(v)) > 0;
  std::vector<Index> region = {apex};
  open_[apex] = 0;
  for (std::size_t i = 0; i < region.size(); ++i) {
    for (const Index f : mesh_.faces_around(region[i])) {
      for (const Index v : mesh_.faces()[f]) {
        if (!open_[v]) continue;
        open_[v] = 0;
        region.push_back(v);
      }
    }
  }
  for (const Index v : own) open_[v] = 0;
  return region;
}

std::vector<Index> DiscCutter::faces_around(const std::vector<Index>& region) const {
  std::vector<Index> faces;
  for (const Index v : region) faces.insert(faces.end(), mesh_.faces_around(v).begin(), mesh_.faces_around(v).end());
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

// A connected region that touches no rim is a disc if its Euler characteristic is 1.
bool DiscCutter::is_disc(const std::vector<Index>& region) const {
  const std::set<Index> inside(region.begin(), region.end());
  std::size_t half_edges = 0, faces = 0;
  for (const Index f : faces_around(region)) {
    const auto& [a, b, c] = mesh_.faces()[f];
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
      const double high = height(mesh_.position(in)), low = height(mesh_.position(out));
      const double t = low < 0 ? std::clamp(high / (high - low), kNearestCut, 1 - kNearestCut) : 0.5;
      it->second = mesh_.add_vertex(
          {(1 - t) * mesh_.position(in) + t * mesh_.position(out), mesh_.vertex(t < 0.5 ? in : out).source});
    }
    return it->second;
  };
  std::map<Index, Index> next;  // along the rim
  for (const Index f : faces_around(region)) {
    Triangle face = mesh_.faces()[f];
    mesh_.remove_face(f);
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
      mesh_.add_face({a, q, p});
    }
  }
  std::vector<Index> rim = {next.begin()->first};
  for (Index v = next.begin()->second; v != rim.front(); v = next.at(v)) rim.push_back(v);
  return rim;
}

void DiscCutter::collapse_short_edges(std::vector<Index>& rim, double shortest) {
  for (std::size_t i = 0; i < rim.size() && rim.size() > kShortestRim;) {
    const std::size_t next = (i + 1) % rim.size();
    if ((mesh_.position(rim[i]) - mesh_.position(rim[next])).norm() >= shortest || !may_collapse(rim[next], rim[i])) {
      ++i;
      continue;
    }
    mesh_.take(mesh_.collapsing(rim[next], rim[i], mesh_.vertex(rim[i])));
    rim.erase(rim.begin() + static_cast<std::ptrdiff_t>(next));
  }
}

// The face at the border edge provides the only common neighbour, and each vertex keeps at least one face.
bool DiscCutter::may_collapse(Index v, Index into) const {
  std::vector<Index> a, b, common;
  mesh_.neighbours(v, a);
  mesh_.neighbours(into, b);
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return common.size() == 1 && a.size() > 2 && b.size() > 2;
}

// Splits the quad along its shorter diagonal.
void DiscCutter::add_quad(Index a, Index b, Index c, Index d) {
  if ((mesh_.position(a) - mesh_.position(c)).squaredNorm() < (mesh_.position(b) - mesh_.position(d)).squaredNorm()) {
    mesh_.add_face({a, b, c});
    mesh_.add_face({a, c, d});
  } else {
    mesh_.add_face({a, b, d});
    mesh_.add_face({b, c, d});
  }
}

std::vector<Index> DiscCutter::open_window(const Vec3& near) {
  const auto center = [&](Index f) -> Vec3 {
    const auto [a, b, c] = mesh_.corners(f);
    return (a + b + c) / 3;
  };
  Index best = kNone;
  for (Index f = 0; f < mesh_.faces().size(); ++f) {
    if (!mesh_.has_face(f)) continue;
    if (best == kNone || (center(f) - near).squaredNorm() < (center(best) - near).squaredNorm()) best = f;
  }
  const Triangle outer = mesh_.faces()[best];
  const Vec3 middle = center(best);
  std::vector<Index> window;
  for (const Index v : outer)
    window.push_back(mesh_.add_vertex({0.5 * (mesh_.position(v) + middle), mesh_.vertex(v).source}));
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    add_quad(outer[i], outer[next], window[next], window[i]);
  }
  mesh_.remove_face(best);
  return window;
}

}  // namespace vmesh

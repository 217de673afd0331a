#include "surface/cut/plane_parting.h"

#include <algorithm>
#include <set>

#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/disc.h"

namespace vmesh {
namespace {

/// Builds the surface part by part.
class PlaneParting {
 public:
  PlaneParting(const SurfaceAtPlane& surface, const std::vector<Index>& in_plane)
      : s_(surface), in_plane_(in_plane), faces_(surface.table.faces()) {
    for (Index v = 0; v < s_.positions.size(); ++v) origin_.push_back({v, v, 0});
    points_ = s_.positions;
    for (Index f = 0; f < faces_.size(); ++f) face_origin_.push_back(f);
  }

  std::optional<CutSurface> run(const PlaneLoop& loop) {
    std::set<Index> touched(loop.faces.begin(), loop.faces.end());
    for (const Index v : in_plane_) {
      const std::vector<Index>& around = s_.table.faces_around(v);
      touched.insert(around.begin(), around.end());
    }
    for (const Index f : touched) divide(f);
    for (const Index f : touched) note_edge_in_plane(f);
    if (!find_ring()) return std::nullopt;
    detach_front();
    CutSurface result;
    add_caps(result);
    result.mesh = {std::move(points_), std::move(faces_)};
    result.vertex_origin = std::move(origin_);
    result.face_origin = std::move(face_origin_);
    result.moved = in_plane_;
    return result;
  }

 private:
  double distance(Index v) const { return s_.distance[v]; }

  Index add_point(const Vec3& point, const CutSurface::VertexOrigin& from) {
    points_.push_back(point);
    origin_.push_back(from);
    return static_cast<Index>(points_.size() - 1);
  }

  /// The point of an edge in the plane, the same from either side.
  Index point_on(Index a, Index b) {
    if (a > b) std::swap(a, b);
    const auto [found, is_new] = point_of_edge_.try_emplace({a, b}, kNone);
    if (is_new) {
      const double share = share_at_plane(distance(a), distance(b));
      const Vec3 point = (1 - share) * points_[a] + share * points_[b];
      found->second = add_point(point - s_.plane.distance(point) * s_.plane.normal, {a, b, share});
    }
    return found->second;
  }

  void set_part(Index f, const Triangle& face, bool front, bool first) {
    if (first) {
      faces_[f] = face;
    } else {
      face_origin_.push_back(f);
      faces_.push_back(face);
      f = static_cast<Index>(faces_.size() - 1);
    }
    if (front) front_.push_back(f);
  }

  /// A quadrilateral as two triangles, the better of both ways.
  void set_quad(Index f, const std::array<Index, 4>& q, bool front, bool first) {
    const auto worst = [&](const Triangle& x, const Triangle& y) {
      const auto skewness = [&](const Triangle& t) {
        return equiangle_skewness(points_[t[0]], points_[t[1]], points_[t[2]]);
      };
      return std::max(skewness(x), skewness(y));
    };
    const Triangle a{q[0], q[1], q[2]}, b{q[0], q[2], q[3]}, c{q[0], q[1], q[3]}, d{q[1], q[2], q[3]};
    const bool by_first = worst(a, b) <= worst(c, d);
    set_part(f, by_first ? a : c, front, first);
    set_part(f, by_first ? b : d, front, false);
  }

  /// Divides a face that has corners on both sides; notes faces before the plane that touch it.
  void divide(Index f) {
    Triangle face = s_.table.faces()[f];
    const auto count = [&](auto is) {
      return std::count_if(face.begin(), face.end(), [&](Index v) { return is(distance(v)); });
    };
    const auto behind = count([](double d) { return d < 0; }), before = count([](double d) { return d > 0; });
    if (behind == 0) front_.push_back(f);
    if (behind == 0 || before == 0) return;
    // The corner in the plane first, or the one that is alone on its side.
    const auto is_first = [&](Index v) {
      if (behind + before == 2) return distance(v) == 0;
      return behind == 1 ? distance(v) < 0 : distance(v) > 0;
    };
    while (!is_first(face[0])) std::rotate(face.begin(), face.begin() + 1, face.end());
    const auto& [v, w, x] = face;
    if (behind + before == 2) {
      const Index q = point_on(w, x);
      const bool front = distance(w) > 0;
      set_part(f, {v, w, q}, front, true);
      set_part(f, {v, q, x}, !front, false);
      front ? note_edge(v, q) : note_edge(q, v);
      return;
    }
    const Index p = point_on(v, w), q = point_on(v, x);
    const bool front = distance(v) > 0;
    set_part(f, {v, p, q}, front, true);
    set_quad(f, {p, w, x, q}, !front, false);
    front ? note_edge(q, p) : note_edge(p, q);
  }

  /// An edge of the ring, as it runs in the face behind the plane.
  void note_edge(Index from, Index to) { simple_ = next_.emplace(from, to).second && simple_; }

  /// An edge of a face behind the plane that lies in it, with the other face before it.
  void note_edge_in_plane(Index f) {
    const Triangle& face = s_.table.faces()[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index u = face[k], v = face[(k + 1) % 3];
      if (distance(u) != 0 || distance(v) != 0 || !(distance(face[(k + 2) % 3]) < 0)) continue;
      const Index other = s_.table.face_of(v, u);
      if (other != kNone && distance(FaceTable::apex(s_.table.faces()[other], {v, u})) > 0)
        note_edge(u, v);
      else
        simple_ = false;  // the surface only touches the plane
    }
  }

  bool find_ring() {
    if (!simple_ || next_.size() < 3) return false;
    const Index start = next_.begin()->first;
    for (Index v = start;;) {
      ring_.push_back(v);
      const auto found = next_.find(v);
      if (found == next_.end() || ring_.size() > next_.size()) return false;
      v = found->second;
      if (v == start) break;
    }
    std::reverse(ring_.begin(), ring_.end());  // counter-clockwise about the plane's normal, as the first cap is
    if (ring_.size() != next_.size()) return false;
    return std::all_of(in_plane_.begin(), in_plane_.end(), [&](Index v) { return next_.contains(v); });
  }

  /// Gives the faces before the plane a ring of their own.
  void detach_front() {
    std::map<Index, Index> copy;
    for (const Index v : ring_) {
      front_ring_.push_back(add_point(points_[v], origin_[v]));
      copy[v] = front_ring_.back();
    }
    for (const Index f : front_) {
      for (Index& v : faces_[f]) {
        if (const auto found = copy.find(v); found != copy.end()) v = found->second;
      }
    }
  }

  void add_caps(CutSurface& result) {
    std::vector<Vec3> ring;
    for (const Index v : ring_) ring.push_back(points_[v]);
    const Disc disc = fill_ring(ring, s_.plane.normal);
    result.cap_area_mm2 = area_vector(ring).norm();
    for (std::size_t side = 0; side < 2; ++side) {
      CutSurface::Cap& cap = result.cap[side];
      cap.ring = side == 0 ? ring_ : front_ring_;
      cap.first_face = static_cast<Index>(faces_.size());
      cap.face_count = static_cast<Index>(disc.faces.size());
      const auto inner = static_cast<Index>(points_.size());
      for (const Vec3& p : disc.vertices) add_point(p, {cap.ring[0], cap.ring[0], 0});
      cap.vertex = disc.vertices.empty() ? cap.ring[0] : inner;
      const auto vertex = [&](Index i) {
        return i < ring.size() ? cap.ring[i] : inner + i - static_cast<Index>(ring.size());
      };
      for (Triangle face : disc.faces) {
        if (side == 1) std::swap(face[1], face[2]);
        faces_.push_back({vertex(face[0]), vertex(face[1]), vertex(face[2])});
        face_origin_.push_back(kNone);
      }
    }
    // Of the second cap, counter-clockwise is the other way round.
    std::reverse(result.cap[1].ring.begin(), result.cap[1].ring.end());
    // What new vertices come from are vertices of before.
    for (CutSurface::VertexOrigin& origin : origin_) {
      if (origin.a == origin.b) origin = origin_[origin.a];
    }
  }

  const SurfaceAtPlane& s_;
  const std::vector<Index>& in_plane_;
  std::vector<Triangle> faces_;
  std::vector<Index> face_origin_, front_;  // front: faces before the plane that may touch the ring
  std::vector<Vec3> points_;
  std::vector<CutSurface::VertexOrigin> origin_;
  std::map<std::array<Index, 2>, Index> point_of_edge_;
  std::map<Index, Index> next_;  // along the ring, for the faces behind the plane
  bool simple_ = true;
  std::vector<Index> ring_, front_ring_;
};

}  // namespace

std::optional<CutSurface> part_at_plane(const SurfaceAtPlane& surface, const PlaneLoop& loop,
                                        const std::vector<Index>& in_plane) {
  return PlaneParting(surface, in_plane).run(loop);
}

}  // namespace vmesh

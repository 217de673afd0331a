#include "surface/pieces/assembly.h"

#include <numbers>

#include "surface/tubes/stitch.h"

namespace vmesh {
namespace {

constexpr int kFewestOnCap = 4;  // vertices of a cap's ring: three would be a single face; safe 3 to 6

std::vector<Index> reversed(std::vector<Index> loop) {
  std::reverse(loop.begin(), loop.end());
  return loop;
}

}  // namespace

Assembly::Assembly(const VesselRings& tubes, const PiecePlan& plan, const GrowthSkeleton& skeleton,
                   const std::vector<char>& open)
    : tubes_(tubes), plan_(plan), skeleton_(skeleton), open_(open), first_(skeleton.tubes.size()) {
  for (Index t = 0; t < skeleton.tubes.size(); ++t) add_tube(t);
}

// Adds the rings of a tube that no junction replaces.
void Assembly::add_tube(Index number) {
  const Tube& tube = skeleton_.tubes[number];
  const std::size_t count = tube.rings.size(), given = rings_given_away(tube);
  const std::size_t begin = tube.starts_at_junction() ? given : 0;
  const std::size_t end = tube.ends_at_junction() ? count - given : count;
  first_[number].resize(count, kNone);
  for (std::size_t k = begin; k < end; ++k) {
    first_[number][k] = size();
    const double lift = is_seam(tube, k) ? kAsLaid : 0;
    for (const RingPoint& p : tube.rings[k].points) vertices_.push_back({p.position, p.cone, 1, lift});
  }
  for (std::size_t k = begin; k + 1 < end; ++k) band(ring_vertices(number, k), ring_vertices(number, k + 1));
  if (tube.periodic) band(ring_vertices(number, count - 1), ring_vertices(number, 0));
  if (tube.starts_at_tip) end_at_tip(tube, 0, -1, reversed(ring_vertices(number, 0)));
  if (tube.ends_at_tip) end_at_tip(tube, count - 1, 1, ring_vertices(number, count - 1));
  if (tube.starts_at_seam) loops_.push_back({kNone, seam_at(tube, false), reversed(ring_vertices(number, 0)), true});
  if (tube.ends_at_seam) loops_.push_back({kNone, seam_at(tube, true), ring_vertices(number, count - 1), false});
}

// The ring of the stretch's end at which the tube ends.
RingPlace Assembly::seam_at(const Tube& tube, bool at_last) const {
  for (std::size_t i = 0; i < plan_.stretches.size(); ++i) {
    const std::vector<Ring>& rings = skeleton_.rings[i];
    const Ring* ring = at_last ? &rings.back() : &rings.front();
    if (ring != (at_last ? &tube.rings.back() : &tube.rings.front())) continue;
    const Stretch& s = plan_.stretches[i];
    const auto count = tubes_.ring_count(s.branch);
    return {s.branch, at_last ? (s.first + s.count - 1) % count : s.first};
  }
  throw std::logic_error("a seam is not a ring of its piece");
}

void Assembly::add_junction(const Junction& junction, const DockedJunction& docked) {
  const std::vector<TubeEnd> docks = docks_of(junction);
  std::vector<Index> number;
  for (const DockedVertex& v : docked.vertices) {
    if (v.dock == kNone) {
      number.push_back(size());
      vertices_.push_back({v.position, v.cone, v.fineness, v.lift, v.elongation_share});
    } else {
      const auto [tube, at_end] = docks[v.dock];
      number.push_back(first_[tube][kept_ring(skeleton_.tubes[tube], at_end)] + v.number);
    }
  }
  for (const auto& [a, b, c] : docked.faces) faces_.push_back({number[a], number[b], number[c]});
}

std::vector<PieceLoop> Assembly::build(BoundSurface& surface) const {
  std::vector<Vertex> vertex(vertices_.size(), SurfaceMesh::null_vertex());
  for (const Triangle& f : faces_) {
    for (const Index v : f) {
      if (vertex[v] != SurfaceMesh::null_vertex()) continue;
      const SurfacePoint& p = vertices_[v];
      vertex[v] = surface.mesh.add_vertex(p.position);
      surface.place(vertex[v], p.position, surface.field.sample_fast(p.position, p.cone));
      surface[vertex[v]].fineness = p.fineness;
      surface[vertex[v]].elongation_share = p.elongation_share;
      surface[vertex[v]].lift = p.lift == kAsLaid ? surface[vertex[v]].distance : p.lift;
    }
  }
  for (const auto& [a, b, c] : faces_) {
    if (surface.mesh.add_face(vertex[a], vertex[b], vertex[c]) == SurfaceMesh::null_face())
      throw std::logic_error("pieces of the surface are inconsistent");
  }
  surface.update_elongation();
  std::vector<PieceLoop> loops;
  for (const Loop& loop : loops_) {
    PieceLoop result{loop.node, loop.seam, {}};
    for (const Index v : loop.vertices) result.vertices.push_back(vertex[v]);
    Vec3 center = Vec3::Zero();
    for (const Vertex v : result.vertices) center += surface.position(v) / static_cast<double>(loop.vertices.size());
    surface.close_with_lid(result.vertices, loop.node == kNone ? center : tubes_.centerline().node(loop.node).position);
    if (loop.reversed) std::reverse(result.vertices.begin(), result.vertices.end());
    loops.push_back(std::move(result));
  }
  return loops;
}

// Closes the tube's end with a cap, or leaves it open.
void Assembly::end_at_tip(const Tube& tube, std::size_t k, double side, std::vector<Index> loop) {
  const auto& nodes = tubes_.axes()[tube.branch].branch().nodes;
  const Index node = side < 0 ? nodes.front() : nodes.back();
  if (open_[node]) {
    loops_.push_back({node, {}, std::move(loop), false});
  } else {
    cap(tube.rings[k], side, std::move(loop));
  }
}

std::vector<Index> Assembly::ring_vertices(Index tube, std::size_t k) const {
  std::vector<Index> ring(skeleton_.tubes[tube].rings[k].points.size());
  for (std::size_t j = 0; j < ring.size(); ++j) ring[j] = first_[tube][k] + static_cast<Index>(j);
  return ring;
}

std::vector<Vec3> Assembly::positions(const std::vector<Index>& loop) const {
  std::vector<Vec3> result;
  for (const Index v : loop) result.push_back(vertices_[v].position);
  return result;
}

void Assembly::band(const std::vector<Index>& bottom, const std::vector<Index>& top) {
  const auto vertex = [&](Index i) { return i < bottom.size() ? bottom[i] : top[i - bottom.size()]; };
  for (const auto& [a, b, c] : stitch(positions(bottom), positions(top)))
    faces_.push_back({vertex(a), vertex(b), vertex(c)});
}

// Closes a tip's loop with a hemisphere: rings with ever fewer vertices, then a pole.
void Assembly::cap(const Ring& ring, double side, std::vector<Index> loop) {
  const double quarter = std::numbers::pi / 2;
  const auto around = static_cast<double>(loop.size());
  const int bands = std::max(1, static_cast<int>(std::round(quarter / ring_pitch(static_cast<int>(loop.size())))));
  const Vec3 pole = side * ring.normal;
  const Vec3 across = (vertices_[loop.front()].position - ring.center).normalized(), up = pole.cross(across);
  const auto add = [&](const Vec3& way) {
    vertices_.push_back({ring.center + ring.radius * way, ring.points.front().cone});
    return static_cast<Index>(vertices_.size() - 1);
  };
  for (int k = 1; k < bands; ++k) {
    const double latitude = quarter * k / bands;
    const int count = std::max(kFewestOnCap, static_cast<int>(std::round(around * std::cos(latitude))));
    std::vector<Index> next;
    for (int j = 0; j < count; ++j) {
      const double angle = 2 * std::numbers::pi * (j + 0.5 * (k % 2)) / count;
      next.push_back(
          add(std::sin(latitude) * pole + std::cos(latitude) * (std::cos(angle) * across + std::sin(angle) * up)));
    }
    band(loop, next);
    loop = std::move(next);
  }
  const Index apex = add(pole);
  for (std::size_t j = 0; j < loop.size(); ++j) faces_.push_back({loop[j], loop[(j + 1) % loop.size()], apex});
}

}  // namespace vmesh

#include "wall_shells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "vmesh/core/disjoint_sets.h"

#include "wall_cleaning.h"
#include "wall_text.h"

namespace vmesh::skeleton {
namespace {

constexpr int kMostSplits = 20;

/// A surface while its sides find each other.
struct Connected {
  TriMesh mesh;
  Mates mates;
  std::vector<bool> is_odd;  // of faces: at an edge with an odd number of them, three or more
  DisjointSets pieces{0};    // of faces
};

Index vertex_at(const TriMesh& mesh, Index side) { return mesh.faces[side / 3][side % 3]; }
Index next_side(Index side) { return side / 3 * 3 + (side + 1) % 3; }

void mate(Mates& mates, Index a, Index b) {
  mates[a] = b;
  mates[b] = a;
}

/// A side by the direction of its face around the edge.
struct Spoke {
  double angle;  // counter-clockwise, seen against the edge's direction from low to high
  Index side;
  bool opens;  // what is counter-clockwise of the face is inside

  auto key() const { return std::pair(angle, side); }
};

std::vector<Spoke> spokes_of(const TriMesh& mesh, std::span<const EdgeSide> edge) {
  const Vec3& from = mesh.vertices[edge[0].low];
  const Vec3 axis = (mesh.vertices[edge[0].high] - from).normalized();
  const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
  std::vector<Spoke> spokes;
  for (const EdgeSide& side : edge) {
    const Vec3 out = mesh.vertices[vertex_at(mesh, next_side(next_side(side.side)))] - from;
    spokes.push_back({std::atan2(out.dot(v), out.dot(u)), side.side, vertex_at(mesh, side.side) != side.low});
  }
  std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) { return a.key() < b.key(); });
  return spokes;
}

/// Mates faces with the inside between them, as brackets are matched.
void mate_around_inside(Mates& mates, std::vector<Spoke> spokes) {
  int depth = 0, deepest = 0;
  std::size_t start = 0;
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    depth += spokes[i].opens ? 1 : -1;
    if (depth < deepest) deepest = depth, start = i + 1;
  }
  std::rotate(spokes.begin(), spokes.begin() + static_cast<std::ptrdiff_t>(start), spokes.end());
  std::vector<Index> open;
  for (const Spoke& spoke : spokes) {
    if (spoke.opens) {
      open.push_back(spoke.side);
    } else {
      mate(mates, open.back(), spoke.side);
      open.pop_back();
    }
  }
}

/// Mates neighbours so that the angles between them are small.
void mate_nearest(Mates& mates, const std::vector<Spoke>& spokes) {
  double even = 0;
  for (std::size_t i = 0; i < spokes.size(); i += 2) even += spokes[i + 1].angle - spokes[i].angle;
  const std::size_t first = even <= std::numbers::pi ? 0 : 1;
  for (std::size_t i = first; i < spokes.size() + first; i += 2)
    mate(mates, spokes[i].side, spokes[(i + 1) % spokes.size()].side);
}

void mate_sides(Connected& surface) {
  surface.mates.assign(3 * surface.mesh.faces.size(), kNone);
  surface.is_odd.assign(surface.mesh.faces.size(), false);
  surface.pieces = DisjointSets(surface.mesh.faces.size());
  visit_edges(sides_by_edge(surface.mesh), [&](std::span<const EdgeSide> edge) {
    if (edge.size() == 2) {
      mate(surface.mates, edge[0].side, edge[1].side);
    } else if (edge.size() > 2 && edge.size() % 2 == 1) {
      for (const EdgeSide& side : edge) {
        surface.is_odd[side.side / 3] = true;
        surface.pieces.join(edge[0].side / 3, side.side / 3);
      }
    } else if (edge.size() > 2) {
      const std::vector<Spoke> spokes = spokes_of(surface.mesh, edge);
      const auto opening = std::count_if(spokes.begin(), spokes.end(), [](const Spoke& s) { return s.opens; });
      if (2 * opening == static_cast<std::ptrdiff_t>(spokes.size())) {
        mate_around_inside(surface.mates, spokes);
      } else {
        mate_nearest(surface.mates, spokes);
      }
    }
  });
  for (Index side = 0; side < surface.mates.size(); ++side) {
    if (surface.mates[side] != kNone) surface.pieces.join(side / 3, surface.mates[side] / 3);
  }
}

struct Turns {
  std::vector<bool> turned;    // of faces
  std::vector<bool> has_none;  // of pieces, under their first faces: there is no way to turn them
  std::size_t count = 0;       // of faces turned against most of their pieces
};

/// Turns faces to the side of the first of their piece.
Turns turns_of(Connected& surface) {
  const TriMesh& mesh = surface.mesh;
  Turns turns{std::vector<bool>(mesh.faces.size(), false), std::vector<bool>(mesh.faces.size(), false)};
  std::vector<bool> seen(mesh.faces.size(), false);
  std::vector<Index> front;
  for (Index first = 0; first < mesh.faces.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = true;
    front = {first};
    std::size_t turned = 0;
    for (std::size_t i = 0; i < front.size(); ++i) {
      const Index f = front[i];
      turned += turns.turned[f] ? 1 : 0;
      for (Index side = 3 * f; side < 3 * f + 3; ++side) {
        const Index other = surface.mates[side];
        if (other == kNone) continue;
        const bool same_way = vertex_at(mesh, side) == vertex_at(mesh, other);
        const bool wanted = turns.turned[f] != same_way;
        if (!seen[other / 3]) {
          seen[other / 3] = true;
          turns.turned[other / 3] = wanted;
          front.push_back(other / 3);
        } else if (turns.turned[other / 3] != wanted) {
          turns.has_none[surface.pieces.find(f)] = true;
        }
      }
    }
    if (2 * turned > front.size()) {
      for (const Index f : front) turns.turned[f] = !turns.turned[f];
      turned = front.size() - turned;
    }
    turns.count += turned;
  }
  return turns;
}

// Corners 0, 1, 2 become 0, 2, 1; sides 0, 1, 2 become 2, 1, 0.
void turn_faces(Connected& surface, const std::vector<bool>& turned) {
  const auto moved = [&](Index side) { return turned[side / 3] ? side / 3 * 3 + 2 - side % 3 : side; };
  Mates mates(surface.mates.size(), kNone);
  for (Index side = 0; side < mates.size(); ++side) {
    if (surface.mates[side] != kNone) mates[moved(side)] = moved(surface.mates[side]);
  }
  surface.mates = std::move(mates);
  for (Index f = 0; f < turned.size(); ++f) {
    if (turned[f]) std::swap(surface.mesh.faces[f][1], surface.mesh.faces[f][2]);
  }
}

/// Gives every fan of faces a vertex of its own; the result is by corners.
std::vector<Index> fans_of(const Connected& surface) {
  const TriMesh& mesh = surface.mesh;
  DisjointSets corners(3 * mesh.faces.size());
  for (Index side = 0; side < surface.mates.size(); ++side) {
    const Index other = surface.mates[side];
    if (other == kNone || other < side) continue;
    const bool same_way = vertex_at(mesh, side) == vertex_at(mesh, other);
    corners.join(side, same_way ? other : next_side(other));
    corners.join(next_side(side), same_way ? next_side(other) : other);
  }
  std::vector<Index> fan(3 * mesh.faces.size());
  for (Index corner = 0; corner < fan.size(); ++corner) fan[corner] = corners.find(corner);
  return fan;
}

/// Puts a vertex into the middle of a side and its mate, which run in opposite directions.
void split_side(Connected& surface, Index side) {
  TriMesh& mesh = surface.mesh;
  Mates& mates = surface.mates;
  const Index other = mates[side], middle = static_cast<Index>(mesh.vertices.size());
  const Vec3 place = 0.5 * (mesh.vertices[vertex_at(mesh, side)] + mesh.vertices[vertex_at(mesh, next_side(side))]);
  mesh.vertices.push_back(place);
  Index fresh[2];
  for (const int which : {0, 1}) {
    const Index s = which == 0 ? side : other, after = next_side(s), last = next_side(after);
    // The face (a, b, c) at side a b becomes (a, m, c), and (m, b, c) is new.
    fresh[which] = static_cast<Index>(mates.size());
    mesh.faces.push_back({middle, vertex_at(mesh, after), vertex_at(mesh, last)});
    mesh.faces[s / 3][after % 3] = middle;
    mates.insert(mates.end(), {kNone, kNone, kNone});
    if (mates[after] != kNone) mate(mates, fresh[which] + 1, mates[after]);
    mate(mates, fresh[which] + 2, after);
  }
  mate(mates, side, fresh[1]);
  mate(mates, other, fresh[0]);
}

/// Divides sides whose edge is that of other faces too even though every fan has a vertex of its own: where a surface
/// touches itself along a single edge.
void split_shared_edges(Connected& surface) {
  for (int pass = 0; pass < kMostSplits; ++pass) {
    const std::vector<Index> fan = fans_of(surface);
    TriMesh by_fan{std::vector<Vec3>(fan.size()), {}};
    for (Index f = 0; 3 * f < fan.size(); ++f) by_fan.faces.push_back({fan[3 * f], fan[3 * f + 1], fan[3 * f + 2]});
    std::vector<Index> shared;
    visit_edges(sides_by_edge(by_fan), [&](std::span<const EdgeSide> edge) {
      for (std::size_t i = 1; edge.size() > 2 && i < edge.size(); ++i) {
        const Index side = edge[i].side, other = surface.mates[side];
        if (other != kNone && side < other && other != edge[0].side) shared.push_back(side);
      }
    });
    if (shared.empty()) return;
    std::vector<bool> touched(surface.mesh.faces.size(), false);  // one division of a face at a time
    for (const Index side : shared) {
      const Index f = side / 3, g = surface.mates[side] / 3;
      if (touched[f] || touched[g]) continue;
      touched[f] = touched[g] = true;
      split_side(surface, side);
    }
  }
}

/// The pieces with vertices of their own, in the order of their first faces.
std::vector<TriMesh> pieces_of(const Connected& surface) {
  const std::vector<Index> fan = fans_of(surface);
  DisjointSets pieces(surface.mesh.faces.size());
  for (Index side = 0; side < surface.mates.size(); ++side) {
    if (surface.mates[side] != kNone) pieces.join(side / 3, surface.mates[side] / 3);
  }
  std::vector<Index> number(surface.mesh.faces.size(), kNone), vertex(fan.size(), kNone);
  std::vector<TriMesh> result;
  for (Index f = 0; f < surface.mesh.faces.size(); ++f) {
    Index& n = number[pieces.find(f)];
    if (n == kNone) {
      n = static_cast<Index>(result.size());
      result.emplace_back();
    }
    TriMesh& piece = result[n];
    Triangle face;
    for (Index i = 0; i < 3; ++i) {
      Index& v = vertex[fan[3 * f + i]];
      if (v == kNone) {
        v = static_cast<Index>(piece.vertices.size());
        piece.vertices.push_back(surface.mesh.vertices[surface.mesh.faces[f][i]]);
      }
      face[i] = v;
    }
    piece.faces.push_back(face);
  }
  return result;
}

/// Takes the pieces without sides out of `surface`, their vertices as they are.
std::vector<TriMesh> take_unsound(Connected& surface, const Turns& turns) {
  std::vector<bool> unsound(surface.mesh.faces.size(), false), kept(surface.mesh.faces.size(), true);
  for (Index f = 0; f < surface.mesh.faces.size(); ++f) {
    if (surface.is_odd[f] || turns.has_none[f]) unsound[surface.pieces.find(f)] = true;
  }
  std::vector<Index> number(surface.mesh.faces.size(), kNone), vertex(surface.mesh.vertices.size(), kNone);
  std::vector<std::vector<Index>> faces;
  for (Index f = 0; f < surface.mesh.faces.size(); ++f) {
    const Index root = surface.pieces.find(f);
    if (!unsound[root]) continue;
    kept[f] = false;
    if (number[root] == kNone) {
      number[root] = static_cast<Index>(faces.size());
      faces.emplace_back();
    }
    faces[number[root]].push_back(f);
  }
  std::vector<TriMesh> result;
  for (const std::vector<Index>& members : faces) {
    TriMesh& mesh = result.emplace_back();
    for (const Index f : members) {
      Triangle face = surface.mesh.faces[f];
      for (Index& v : face) {
        Index& n = vertex[v];
        if (n == kNone || n >= mesh.vertices.size() || mesh.vertices[n] != surface.mesh.vertices[v]) {
          n = static_cast<Index>(mesh.vertices.size());
          mesh.vertices.push_back(surface.mesh.vertices[v]);
        }
        v = n;
      }
      mesh.faces.push_back(face);
    }
  }
  if (!result.empty()) {
    keep_faces(surface.mesh, kept);
    mate_sides(surface);
  }
  return result;
}

}  // namespace

Mates mates_of(const TriMesh& mesh) {
  Mates mates(3 * mesh.faces.size(), kNone);
  visit_edges(sides_by_edge(mesh), [&](std::span<const EdgeSide> edge) {
    if (edge.size() == 2) mate(mates, edge[0].side, edge[1].side);
  });
  return mates;
}

WallShells shells_of(const TriMesh& surface) {
  WallShells shells;
  Connected connected;
  connected.mesh = cleaned_soup(surface, shells.notes);
  drop_fins(connected.mesh, shells.notes);
  cut_out_odd_edges(connected.mesh, shells.notes);
  mate_sides(connected);
  Turns turns = turns_of(connected);
  shells.unsound = take_unsound(connected, turns);
  if (!shells.unsound.empty()) turns = turns_of(connected);
  turn_faces(connected, turns.turned);
  if (turns.count > 0) {
    shells.notes.push_back(counted(turns.count, "face that faced another side than its neighbours is turned",
                                   "faces that faced another side than their neighbours are turned"));
  }
  split_shared_edges(connected);
  shells.sound = pieces_of(connected);
  return shells;
}

}  // namespace vmesh::skeleton

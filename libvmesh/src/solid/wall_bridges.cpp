#include "solid/wall_bridges.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "vmesh/mesh/volume_faces.h"
#include "vmesh/quality/closest_point.h"

#include "solid/core_improvement.h"

namespace vmesh {
namespace {

// Bridges of a worse shape (see BadPlaces; about 3 degrees) are left out where they are at the outside.
constexpr double kLeastBridgeShape = 0.05;

Triangle sorted(const CellFace& face) {
  Triangle key = {face[0], face[1], face[2]};
  std::sort(key.begin(), key.end());
  return key;
}

/// The outside of the shell, closed at its ends. Vertices of the wall first.
TriMesh closed_outside(const WallFrame& frame, const LayerStack& shell) {
  TriMesh mesh;
  for (Index v = 0; v < frame.position.size(); ++v) mesh.vertices.push_back(shell.at(frame, v, 1));
  mesh.faces = frame.faces;
  std::vector<Index> on_wall(frame.position.size());
  std::iota(on_wall.begin(), on_wall.end(), 0);
  for (const Cap& cap : frame.caps) {
    for (const Index v : cap.rim) {
      if (shell.ends_at(v)) continue;
      on_wall[v] = static_cast<Index>(mesh.vertices.size());
      mesh.vertices.push_back(frame.position[v]);
    }
    for (std::size_t j = 0; j < cap.rim.size(); ++j) {
      const Index a = cap.rim[(j + 1) % cap.rim.size()], b = cap.rim[j];
      if (on_wall[b] != b) mesh.faces.push_back({on_wall[a], on_wall[b], b});
      if (on_wall[a] != a) mesh.faces.push_back({on_wall[a], b, a});
    }
    const auto added = static_cast<Index>(mesh.vertices.size()), rim = static_cast<Index>(cap.rim.size());
    const auto number = [&](Index i) { return i < rim ? on_wall[cap.rim[i]] : added + i - rim; };
    mesh.vertices.insert(mesh.vertices.end(), cap.disc.vertices.begin(), cap.disc.vertices.end());
    for (const auto& [a, b, c] : cap.disc.faces) mesh.faces.push_back({number(a), number(b), number(c)});
  }
  return mesh;
}

/// Of every vertex of the wall: the smallest number of a vertex that it is connected with.
std::vector<Index> components_of(const WallFrame& frame) {
  std::vector<Index> first(frame.position.size(), kNone);
  for (Index v = 0; v < first.size(); ++v) {
    if (first[v] != kNone) continue;
    std::vector<Index> reached = {v};
    first[v] = v;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      for (const Index f : frame.fan[reached[i]]) {
        for (const Index w : frame.faces[f]) {
          if (first[w] != kNone) continue;
          first[w] = v;
          reached.push_back(w);
        }
      }
    }
  }
  return first;
}

/// A point within each component's outside, on its wall; none for components without any layers.
std::vector<Vec3> points_within(const WallFrame& frame, const LayerStack& shell, const std::vector<Index>& component) {
  std::map<Index, Index> thickest;  // vertex of every component, not on a rim, which is on the outside
  for (Index v = 0; v < component.size(); ++v) {
    if (frame.cap_at[v] != kNone) continue;
    const auto [at, is_new] = thickest.try_emplace(component[v], v);
    if (!is_new && shell.reached_mm[v] > shell.reached_mm[at->second]) at->second = v;
  }
  std::vector<Vec3> points;
  for (const auto& [first, v] : thickest) {
    if (!shell.ends_at(v)) points.push_back(frame.position[v]);
  }
  return points;
}

/// The outside of shells and bridges, to which cells are added.
class Outside {
 public:
  Outside(const WallFrame& frame, const BridgeFaces& faces) : count_(frame.position.size(), 0) {
    for (Index f = 0; f < frame.faces.size(); ++f) {
      if (!faces.is_bridged[f]) add_face(frame.faces[f]);
    }
    for (const Triangle& face : faces.free) add_face(face);
  }

  /// Unless the outside would be no manifold any more.
  bool add(const Tetrahedron& cell) {
    const auto faces = faces_of(cell);
    std::array<bool, 4> is_outside;
    for (std::size_t i = 0; i < 4; ++i) is_outside[i] = faces_.contains(sorted(faces[i]));
    const auto shared = std::count(is_outside.begin(), is_outside.end(), true);
    if (!(shared == 2   ? !has_new_edge_already(faces, is_outside)
          : shared == 3 ? is_closed_over(faces, is_outside)
                        : shared == 4))
      return false;
    for (std::size_t i = 0; i < 4; ++i) {
      const Triangle face = {faces[i][0], faces[i][1], faces[i][2]};
      is_outside[i] ? remove_face(face) : add_face(face);
    }
    return true;
  }

 private:
  void add_face(const Triangle& face) { change(face, 1); }
  void remove_face(const Triangle& face) { change(face, -1); }
  void change(const Triangle& face, int by) {
    const Triangle key = sorted({face[0], face[1], face[2], kNone});
    by > 0 ? void(faces_.insert(key)) : void(faces_.erase(key));
    for (std::size_t i = 0; i < 3; ++i) {
      count_[face[i]] += by;
      edges_[std::minmax(face[i], face[(i + 1) % 3])] += by;
    }
  }

  // Two new faces have an edge in common.
  bool has_new_edge_already(const std::array<CellFace, 4>& faces, const std::array<bool, 4>& is_outside) const {
    std::array<Triangle, 2> fresh;
    for (std::size_t i = 0, n = 0; i < 4; ++i) {
      if (!is_outside[i]) fresh[n++] = sorted(faces[i]);
    }
    Triangle edge;
    std::set_intersection(fresh[0].begin(), fresh[0].end(), fresh[1].begin(), fresh[1].end(), edge.begin());
    const auto found = edges_.find({edge[0], edge[1]});
    return found != edges_.end() && found->second > 0;
  }

  // The vertex that the new face does not have has no other faces.
  bool is_closed_over(const std::array<CellFace, 4>& faces, const std::array<bool, 4>& is_outside) const {
    const auto fresh =
        static_cast<std::size_t>(std::find(is_outside.begin(), is_outside.end(), false) - is_outside.begin());
    for (const Index v : sorted(faces[(fresh + 1) % 4])) {
      if (std::find(faces[fresh].begin(), faces[fresh].end(), v) == faces[fresh].end()) return count_[v] == 3;
    }
    return false;
  }

  std::set<Triangle> faces_;
  std::map<std::pair<Index, Index>, int> edges_;  // number of faces
  std::vector<int> count_;                        // faces at every vertex
};

/// Which of the tetrahedra outside of the shells are bridges.
class BridgeSelection {
 public:
  BridgeSelection(const WallFrame& frame, const LayerStack& shell)
      : frame_(frame), shell_(shell), lumen_({frame.position, frame.faces}) {
    for (Index v = 0; v < frame.position.size(); ++v) outermost_.push_back(shell.at(frame, v, 1));
  }

  std::vector<Tetrahedron> among(const std::vector<Tetrahedron>& tetrahedra) {
    std::copy_if(tetrahedra.begin(), tetrahedra.end(), std::back_inserter(chosen_),
                 [&](const Tetrahedron& cell) { return is_between_walls(cell); });
    candidates_ = chosen_;
    while (leave_out()) {
    }
    while (add_those_that_fit()) {
    }
    return std::move(chosen_);
  }

 private:
  // Ends of vessels keep their rings.
  bool may_be_corner(Index v) const { return v < frame_.position.size() && frame_.cap_at[v] == kNone; }
  bool is_thin(Index v) const { return shell_.reached_mm[v] < kFullLayers * shell_.asked_mm[v]; }

  bool is_between_walls(const Tetrahedron& cell) const {
    if (!std::all_of(cell.begin(), cell.end(), [&](Index v) { return may_be_corner(v); })) return false;
    if (std::none_of(cell.begin(), cell.end(), [&](Index v) { return is_thin(v); })) return false;
    return relative_distance(cell) <= 1;
  }

  // Of the centre of a cell from the nearest lumen, by the thickness of its wall.
  double relative_distance(const Tetrahedron& cell) const {
    const Vec3 centre = (outermost_[cell[0]] + outermost_[cell[1]] + outermost_[cell[2]] + outermost_[cell[3]]) / 4;
    const ClosestPoint closest = lumen_.closest(centre);
    double thickness = 0;
    for (const Index v : frame_.faces[closest.face]) thickness = std::max(thickness, shell_.asked_mm[v]);
    return closest.distance / thickness;
  }

  // Leaves out what is flat at the outside, and the outermost where the outside is no manifold. Whether there was any.
  bool leave_out() {
    const BridgeFaces faces = faces_of_bridges(frame_, {{}, chosen_, {}});
    std::set<Triangle> is_free;
    std::map<Index, std::vector<Triangle>> free_at;
    for (const Triangle& face : faces.free) {
      is_free.insert(sorted({face[0], face[1], face[2], kNone}));
      for (const Index v : face) free_at[v].push_back(face);
    }
    std::vector<char> is_pinched(frame_.position.size(), 0);
    for (const auto& [v, free] : free_at) is_pinched[v] = !is_one_fan(v, free, faces.is_bridged);
    std::vector<char> leaves(chosen_.size(), 0);
    std::map<Index, std::pair<double, std::size_t>> outermost;  // cell at every pinched vertex
    for (std::size_t t = 0; t < chosen_.size(); ++t) {
      const auto cell_faces = faces_of(chosen_[t]);
      if (std::none_of(cell_faces.begin(), cell_faces.end(),
                       [&](const CellFace& face) { return is_free.contains(sorted(face)); }))
        continue;
      leaves[t] = shape(chosen_[t]) < kLeastBridgeShape;
      const std::pair rank(relative_distance(chosen_[t]), t);
      for (const Index v : chosen_[t]) {
        if (is_pinched[v]) outermost[v] = std::max(outermost[v], rank);
      }
    }
    for (const auto& [v, rank] : outermost) leaves[rank.second] = 1;
    std::size_t t = 0;
    return std::erase_if(chosen_, [&](const Tetrahedron&) { return leaves[t++] != 0; }) > 0;
  }

  // Adds cells that leave the outside a manifold, deepest first. Whether there was any.
  bool add_those_that_fit() {
    Outside outside(frame_, faces_of_bridges(frame_, {{}, chosen_, {}}));
    std::vector<std::pair<double, std::size_t>> order;
    const std::set<Tetrahedron> in(chosen_.begin(), chosen_.end());
    for (std::size_t t = 0; t < candidates_.size(); ++t) {
      if (!in.contains(candidates_[t])) order.emplace_back(relative_distance(candidates_[t]), t);
    }
    std::sort(order.begin(), order.end());
    bool any = false;
    for (const auto& [distance, t] : order) {
      const Tetrahedron& cell = candidates_[t];
      if (shape(cell) < kLeastBridgeShape || !outside.add(cell)) continue;
      chosen_.push_back(cell);
      any = true;
    }
    return any;
  }

  double shape(const Tetrahedron& cell) const {
    return tetrahedron_shape({outermost_[cell[0]], outermost_[cell[1]], outermost_[cell[2]], outermost_[cell[3]]});
  }

  // Whether the faces at the outside around a vertex follow each other around it.
  bool is_one_fan(Index v, const std::vector<Triangle>& free, const std::vector<char>& is_bridged) const {
    std::map<Index, Index> next;  // around the vertex, counter-clockwise
    bool is_fan = true;
    const auto add = [&](const Triangle& face) {
      const std::size_t i = static_cast<std::size_t>(std::find(face.begin(), face.end(), v) - face.begin());
      is_fan = next.try_emplace(face[(i + 1) % 3], face[(i + 2) % 3]).second && is_fan;
    };
    for (const Triangle& face : free) add(face);
    for (const Index f : frame_.fan[v]) {
      if (!is_bridged[f]) add(frame_.faces[f]);
    }
    if (!is_fan) return false;
    std::size_t count = 0;
    const Index start = next.begin()->first;
    Index at = start;
    do {
      const auto found = next.find(at);
      if (found == next.end() || ++count > next.size()) return false;
      at = found->second;
    } while (at != start);
    return count == next.size();
  }

  const WallFrame& frame_;
  const LayerStack& shell_;
  ClosestPointIndex lumen_;
  std::vector<Vec3> outermost_;
  std::vector<Tetrahedron> candidates_, chosen_;
};

}  // namespace

Core bridge_walls(const WallFrame& frame, const LayerStack& shell) {
  const std::vector<Index> component = components_of(frame);
  Core all = fill_around(closed_outside(frame, shell), points_within(frame, shell, component));
  if (!all.failure.empty()) return all;
  Core bridges;
  bridges.tetrahedra = BridgeSelection(frame, shell).among(all.tetrahedra);
  CoreSurface surface;
  for (Index v = 0; v < frame.position.size(); ++v) surface.mesh.vertices.push_back(shell.at(frame, v, 1));
  const BridgeFaces faces = faces_of_bridges(frame, bridges);
  surface.mesh.faces = faces.free;
  for (Index f = 0; f < frame.faces.size(); ++f) {
    if (faces.is_bridged[f]) surface.mesh.faces.push_back(frame.faces[f]);
  }
  improve_core(surface, bridges);
  return bridges;
}

BridgeFaces faces_of_bridges(const WallFrame& frame, const Core& bridges) {
  std::map<Triangle, std::pair<CellFace, int>> seen;
  for (const Tetrahedron& cell : bridges.tetrahedra) {
    for (const CellFace& face : faces_of(cell)) ++seen.try_emplace(sorted(face), face, 0).first->second.second;
  }
  BridgeFaces faces;
  for (const auto& [a, b, c] : frame.faces) faces.is_bridged.push_back(seen.erase(sorted({a, b, c, kNone})) > 0);
  for (const auto& [key, face] : seen) {
    if (face.second == 1) faces.free.push_back({face.first[0], face.first[1], face.first[2]});
  }
  return faces;
}

std::vector<MergedPlace> merged_places(const WallFrame& frame, const LayerStack& shell, const Core& bridges) {
  const auto at = [&](Index v) -> Vec3 {
    return v < frame.position.size() ? shell.at(frame, v, 1) : bridges.added[v - frame.position.size()];
  };
  std::map<Index, std::vector<Index>> around;  // cells at every corner
  for (Index t = 0; t < bridges.tetrahedra.size(); ++t) {
    for (const Index v : bridges.tetrahedra[t]) around[v].push_back(t);
  }
  std::vector<char> seen(bridges.tetrahedra.size(), 0);
  std::vector<MergedPlace> places;
  for (Index t = 0; t < seen.size(); ++t) {
    if (seen[t]) continue;
    std::vector<Index> cells = {t};
    seen[t] = 1;
    MergedPlace place;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto& [a, b, c, d] = bridges.tetrahedra[cells[i]];
      const double volume = (at(b) - at(a)).cross(at(c) - at(a)).dot(at(d) - at(a)) / 6;
      place.volume_mm3 += volume;
      place.position += volume * (at(a) + at(b) + at(c) + at(d)) / 4;
      for (const Index v : {a, b, c, d}) {
        for (const Index other : around[v]) {
          if (seen[other]) continue;
          seen[other] = 1;
          cells.push_back(other);
        }
      }
    }
    place.position /= place.volume_mm3;
    place.tetrahedra = cells.size();
    places.push_back(place);
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const MergedPlace& a, const MergedPlace& b) { return a.volume_mm3 > b.volume_mm3; });
  return places;
}

}  // namespace vmesh

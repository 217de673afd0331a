#include "solid/volume_assembly.h"

#include <algorithm>

#include "solid/layer_ends.h"
#include "solid/wall_bridges.h"

namespace vmesh {
namespace {

constexpr Index kLumen = 0;  // region, if there is a lumen

// Mean length of edges at every vertex.
std::vector<double> edge_lengths(const TriMesh& mesh) {
  std::vector<double> sum(mesh.vertices.size(), 0), count(mesh.vertices.size(), 0);
  for (const Triangle& face : mesh.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = face[i], b = face[(i + 1) % 3];
      const double length = (mesh.vertices[b] - mesh.vertices[a]).norm();
      for (const Index v : {a, b}) {
        sum[v] += length;
        count[v] += 1;
      }
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] /= std::max(count[v], 1.0);
  return sum;
}

class Assembly {
 public:
  Assembly(const VolumeParts& parts, const CoreSurface& surface, const Core& core)
      : parts_(parts), frame_(*parts.frame), surface_(surface), core_(core) {}

  VolumeMesh run() {
    add_points();
    name_patches();
    name_regions();
    if (parts_.with_lumen) {
      add_core();
      add_layers(parts_.layers, layer_point_, kLumen);
    }
    const Index last_region = static_cast<Index>(mesh_.region_names.size()) - 1;
    add_layers(parts_.shell, shell_point_, last_region);
    for (const Tetrahedron& t : parts_.bridges.tetrahedra)
      mesh_.tetrahedra.push_back({bridge_point(t[0]), bridge_point(t[1]), bridge_point(t[2]), bridge_point(t[3])});
    region_.tetrahedra.resize(mesh_.tetrahedra.size(), last_region);
    join_regions();
    add_boundary();
    return std::move(mesh_);
  }

 private:
  // Vertices of the wall, then those of layers from the wall on, then those of the core; then those of the shell, at
  // last those of bridges.
  void add_points() {
    mesh_.points = frame_.position;
    if (parts_.with_lumen) {
      layer_point_ = add_levels(parts_.layers);
      const std::size_t n = frame_.position.size();
      core_point_ = static_cast<Index>(mesh_.points.size() - n);
      first_beside_ = static_cast<Index>(surface_.mesh.vertices.size());
      const auto& vertices = surface_.mesh.vertices;
      mesh_.points.insert(mesh_.points.end(), vertices.begin() + static_cast<std::ptrdiff_t>(n), vertices.end());
      mesh_.points.insert(mesh_.points.end(), core_.added.begin(), core_.added.end());
    }
    shell_point_ = add_levels(parts_.shell);
    first_bridge_point_ = static_cast<Index>(mesh_.points.size());
    mesh_.points.insert(mesh_.points.end(), parts_.bridges.added.begin(), parts_.bridges.added.end());
  }

  // Returns, for every vertex, where its points at levels beyond the wall begin; itself where layers end.
  std::vector<Index> add_levels(const LayerStack& stack) {
    std::vector<Index> first(frame_.position.size());
    for (Index v = 0; v < first.size(); ++v) {
      first[v] = stack.ends_at(v) ? v : static_cast<Index>(mesh_.points.size());
      if (stack.ends_at(v)) continue;
      for (std::size_t k = 1; k < stack.level.size(); ++k) mesh_.points.push_back(stack.at(frame_, v, stack.level[k]));
    }
    return first;
  }

  // Of vertex `v` of the wall at level `k`.
  static Index point(const std::vector<Index>& first, std::size_t k, Index v) {
    return k == 0 || first[v] == v ? v : first[v] + static_cast<Index>(k) - 1;
  }
  // Of a vertex of the core's surface, or added.
  Index core_point(Index v) const {
    if (v < frame_.position.size()) return point(layer_point_, parts_.layers.count(), v);
    if (v < first_beside_) return core_point_ + v;
    const auto beside = static_cast<Index>(surface_.beside.size());
    if (v >= first_beside_ + beside) return core_point_ + v - beside;
    const LayerPoint& of_layers = surface_.beside[v - first_beside_];
    return point(layer_point_, of_layers.level, of_layers.vertex);
  }

  Index outermost_point(Index v) const { return point(shell_point_, parts_.shell.count(), v); }
  Index bridge_point(Index v) const {
    const auto n = static_cast<Index>(frame_.position.size());
    return v < n ? outermost_point(v) : first_bridge_point_ + v - n;
  }

  void name_patches() {
    mesh_.patch_names = parts_.wall->patch_names;
    if (!parts_.with_lumen) {
      lumen_wall_ = static_cast<Index>(mesh_.patch_names.size());
      mesh_.patch_names.push_back("lumen_wall");
    }
    if (parts_.shell.count() == 0) return;
    first_shell_end_ = static_cast<Index>(mesh_.patch_names.size());
    for (const Cap& cap : frame_.caps) mesh_.patch_names.push_back(parts_.wall->patch_names[cap.patch] + "_wall");
  }

  void add_core() {
    for (const Tetrahedron& t : core_.tetrahedra)
      mesh_.tetrahedra.push_back({core_point(t[0]), core_point(t[1]), core_point(t[2]), core_point(t[3])});
    region_.tetrahedra.resize(mesh_.tetrahedra.size(), kLumen);
  }

  void add_layers(const LayerStack& stack, const std::vector<Index>& first, Index region) {
    for (std::size_t k = 0; k < stack.count(); ++k) {
      const auto [inner, outer] = stack.side == LayerSide::inside ? std::pair(k + 1, k) : std::pair(k, k + 1);
      for (const Triangle& face : frame_.faces) {
        // There, the lumen's cells are the core's.
        if (stack.side == LayerSide::inside && is_layer_end(stack, face)) continue;
        const auto& [a, b, c] = face;
        add_cell({point(first, inner, a), point(first, inner, b), point(first, inner, c), point(first, outer, a),
                  point(first, outer, b), point(first, outer, c)});
      }
    }
    region_.tetrahedra.resize(mesh_.tetrahedra.size(), region);
    region_.wedges.resize(mesh_.wedges.size(), region);
    region_.pyramids.resize(mesh_.pyramids.size(), region);
  }

  // What is left of a wedge whose corners coincide where layers end.
  void add_cell(Wedge wedge) {
    const auto ends = [&](std::size_t i) { return wedge[i] == wedge[i + 3]; };
    const int count = ends(0) + ends(1) + ends(2);
    if (count == 0) mesh_.wedges.push_back(wedge);
    if (count == 0 || count == 3) return;
    // A corner at which layers end comes last if it is the only one, else that at which they do not comes first.
    while (count == 1 ? !ends(2) : ends(0)) {
      std::rotate(wedge.begin(), wedge.begin() + 1, wedge.begin() + 3);
      std::rotate(wedge.begin() + 3, wedge.begin() + 4, wedge.end());
    }
    const auto& [a, b, c, d, e, f] = wedge;
    if (count == 1) {
      mesh_.pyramids.push_back({a, d, e, b, c});
    } else {
      mesh_.tetrahedra.push_back({a, b, c, d});
    }
  }

  void name_regions() {
    if (parts_.with_lumen) mesh_.region_names.push_back("lumen");
    if (parts_.shell.count() > 0) mesh_.region_names.push_back("wall");
  }

  void join_regions() {
    for (const auto* region : {&region_.tetrahedra, &region_.wedges, &region_.pyramids})
      mesh_.cell_region.insert(mesh_.cell_region.end(), region->begin(), region->end());
  }

  // Of the frame's faces, which are those of the wall in their order.
  std::vector<Index> wall_patches() const {
    const VesselWall& wall = *parts_.wall;
    std::vector<Index> patches;
    for (std::size_t f = 0; f < wall.patch.size(); ++f) {
      if (wall.is_wall(f)) patches.push_back(wall.patch[f]);
    }
    return patches;
  }

  void add_outside() {
    const std::vector<Index> patch = wall_patches();
    const BridgeFaces bridges = faces_of_bridges(frame_, parts_.bridges);
    for (std::size_t f = 0; f < frame_.faces.size(); ++f) {
      const auto& [a, b, c] = frame_.faces[f];
      if (!bridges.is_bridged[f])
        mesh_.boundary.push_back({{outermost_point(a), outermost_point(b), outermost_point(c), kNone}, patch[f]});
    }
    for (const auto& [a, b, c] : bridges.free)
      mesh_.boundary.push_back({{bridge_point(a), bridge_point(b), bridge_point(c), kNone}, 0});
  }

  void add_boundary() {
    add_outside();
    if (!parts_.with_lumen) {
      for (const auto& [a, b, c] : frame_.faces) mesh_.boundary.push_back({{a, c, b, kNone}, lumen_wall_});
    }
    std::size_t face = frame_.faces.size();  // of the core's surface
    for (std::size_t i = 0; i < frame_.caps.size(); ++i) {
      const Cap& cap = frame_.caps[i];
      if (parts_.with_lumen) {
        add_rings(cap, parts_.layers, layer_point_, cap.patch);
        add_disc(face, cap);
      }
      if (parts_.shell.count() > 0)
        add_rings(cap, parts_.shell, shell_point_, first_shell_end_ + static_cast<Index>(i));
    }
  }

  void add_rings(const Cap& cap, const LayerStack& stack, const std::vector<Index>& first, Index patch) {
    for (std::size_t k = 0; k < stack.count(); ++k) {
      for (std::size_t j = 0; j < cap.rim.size(); ++j) {
        Index a = cap.rim[j], b = cap.rim[(j + 1) % cap.rim.size()];
        if (stack.side == LayerSide::outside) std::swap(a, b);
        const Index c = point(first, k + 1, b), d = point(first, k + 1, a);
        a = point(first, k, a);
        b = point(first, k, b);
        if (a != d && b != c) mesh_.boundary.push_back({{a, b, c, d}, patch});
        if (a != d && b == c) mesh_.boundary.push_back({{a, b, d, kNone}, patch});
        if (a == d && b != c) mesh_.boundary.push_back({{a, b, c, kNone}, patch});
      }
    }
  }

  void add_disc(std::size_t& face, const Cap& cap) {
    for (; face < surface_.mesh.faces.size() && surface_cap_of(face) == cap.patch; ++face) {
      const auto& [a, b, c] = surface_.mesh.faces[face];
      mesh_.boundary.push_back({{core_point(a), core_point(b), core_point(c), kNone}, cap.patch});
    }
  }
  Index surface_cap_of(std::size_t face) const { return surface_.cap[face - frame_.faces.size()]; }

  const VolumeParts& parts_;
  const WallFrame& frame_;
  const CoreSurface& surface_;
  const Core& core_;
  VolumeMesh mesh_;
  struct {
    std::vector<Index> tetrahedra, wedges, pyramids;
  } region_;                                      // of every cell
  std::vector<Index> layer_point_, shell_point_;  // of add_levels()
  Index first_bridge_point_ = 0;
  Index core_point_ = 0;    // to be added to a vertex of the core that is none of the wall's
  Index first_beside_ = 0;  // number in the core of the first point beside its surface
  Index lumen_wall_ = 0, first_shell_end_ = 0;
};

}  // namespace

CoreSurface core_surface(const WallFrame& frame, const LayerStack& layers, double core_size) {
  CoreSurface surface;
  for (Index v = 0; v < frame.position.size(); ++v) surface.mesh.vertices.push_back(layers.at(frame, v, 1));
  surface.mesh.faces = frame.faces;
  std::vector<double> radius = frame.radius;
  for (const Cap& cap : frame.caps) {
    const Disc disc = disc_within(frame, cap, layers);
    const auto added = static_cast<Index>(surface.mesh.vertices.size());
    const auto rim = static_cast<Index>(cap.rim.size());
    const auto number = [&](Index i) { return i < rim ? cap.rim[i] : added + i - rim; };
    surface.mesh.vertices.insert(surface.mesh.vertices.end(), disc.vertices.begin(), disc.vertices.end());
    radius.resize(surface.mesh.vertices.size(), frame.radius[cap.rim[0]]);
    for (const auto& [a, b, c] : disc.faces) {
      surface.mesh.faces.push_back({number(a), number(b), number(c)});
      surface.cap.push_back(cap.patch);
    }
  }
  if (core_size > 0) {
    for (const double r : radius) surface.size.push_back(core_size * r);
  } else {
    surface.size = edge_lengths(surface.mesh);
  }
  return surface;
}

VolumeMesh assemble(const VolumeParts& parts, const CoreSurface& surface, const Core& core) {
  return Assembly(parts, surface, core).run();
}

}  // namespace vmesh

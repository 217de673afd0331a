// A straight tube as a volume mesh, made by itself: wedges at the wall, tetrahedra inside.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vmesh/mesh/volume_mesh.h"

namespace vmesh::testing {

struct TubeSizes {
  double radius = 1, length = 4;  // mm
  std::size_t around = 8, along = 4, rings = 2, layers = 2;
  double core = 0.7;  ///< radius of the tetrahedra, in radii
};

/// Along z from 0: cross-sections of concentric rings, three tetrahedra for each prism between these, and around
/// them layers of wedges. Patches: wall, inlet (z = 0), outlet.
inline VolumeMesh tube_volume(const TubeSizes& sizes = {}) {
  VolumeMesh mesh;
  mesh.region_names = {"lumen"};
  mesh.patch_names = {"wall", "inlet", "outlet"};
  const std::size_t section = 1 + sizes.around * sizes.rings;
  const auto point = [&](double r, std::size_t k, std::size_t slice) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(sizes.around);
    return Vec3(r * std::cos(angle), r * std::sin(angle),
                sizes.length * static_cast<double>(slice) / static_cast<double>(sizes.along));
  };
  const auto index = [&](std::size_t slice, std::size_t ring, std::size_t k) {
    return static_cast<Index>(slice * section + (ring == 0 ? 0 : 1 + (ring - 1) * sizes.around + k % sizes.around));
  };
  for (std::size_t s = 0; s <= sizes.along; ++s) {
    mesh.points.push_back(point(0, 0, s));
    for (std::size_t r = 1; r <= sizes.rings; ++r)
      for (std::size_t k = 0; k < sizes.around; ++k)
        mesh.points.push_back(
            point(sizes.core * sizes.radius * static_cast<double>(r) / static_cast<double>(sizes.rings), k, s));
  }
  // Points of a section have lower numbers than those over them. So the three tetrahedra on the way from the least
  // corner to the greatest, and all quads are cut through their least corner.
  const auto add_prism = [&](Triangle base, Index over) {
    std::sort(base.begin(), base.end());
    const auto& [a, b, c] = base;
    for (Tetrahedron t :
         {Tetrahedron{a, b, c, c + over}, {a, b, b + over, c + over}, {a, a + over, b + over, c + over}}) {
      const Vec3 &o = mesh.points[t[0]], &d = mesh.points[t[3]];
      if ((mesh.points[t[1]] - o).cross(mesh.points[t[2]] - o).dot(d - o) < 0) std::swap(t[0], t[1]);
      mesh.tetrahedra.push_back(t);
    }
  };
  std::vector<Triangle> disc;  // at z = 0, seen from above counter-clockwise
  for (std::size_t r = 0; r < sizes.rings; ++r) {
    for (std::size_t k = 0; k < sizes.around; ++k) {
      const Index a = index(0, r, k), b = index(0, r + 1, k), c = index(0, r + 1, k + 1), d = index(0, r, k + 1);
      disc.push_back({a, b, c});
      if (r > 0) disc.push_back({a, c, d});
    }
  }
  const auto top = static_cast<Index>(sizes.along * section);
  for (Index s = 0; s < sizes.along; ++s) {
    for (const auto& [a, b, c] : disc) {
      const auto low = static_cast<Index>(s * section);
      add_prism({a + low, b + low, c + low}, static_cast<Index>(section));
    }
  }
  for (const auto& [a, b, c] : disc) {
    mesh.boundary.push_back({{a, c, b, kNone}, 1});
    mesh.boundary.push_back({{a + top, b + top, c + top, kNone}, 2});
  }
  // The outside of the tetrahedra, each quad cut through its least corner as their prisms are.
  std::vector<Triangle> side;
  for (std::size_t s = 0; s < sizes.along; ++s) {
    for (std::size_t k = 0; k < sizes.around; ++k) {
      const Index a = index(s, sizes.rings, k), b = index(s, sizes.rings, k + 1), c = index(s + 1, sizes.rings, k + 1),
                  d = index(s + 1, sizes.rings, k);
      if (a < b) {
        side.insert(side.end(), {{a, b, c}, {a, c, d}});
      } else {
        side.insert(side.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  // Copies of its points, outwards.
  const auto first_layer = static_cast<Index>(mesh.points.size());
  const auto around = static_cast<Index>(sizes.around);
  const auto in_layer = static_cast<Index>((sizes.along + 1) * sizes.around);
  for (std::size_t l = 1; l <= sizes.layers; ++l) {
    const double share = static_cast<double>(l) / static_cast<double>(sizes.layers);
    for (std::size_t s = 0; s <= sizes.along; ++s)
      for (std::size_t k = 0; k < sizes.around; ++k)
        mesh.points.push_back(point(sizes.radius * (sizes.core + (1 - sizes.core) * share), k, s));
  }
  const auto on_layer = [&](Index v, std::size_t layer) {
    if (layer == 0) return v;
    const Index slice = v / static_cast<Index>(section), k = (v - 1) % static_cast<Index>(section) % around;
    return static_cast<Index>(first_layer + (layer - 1) * in_layer + slice * around + k);
  };
  for (std::size_t l = 0; l < sizes.layers; ++l) {
    for (const auto& [a, b, c] : side)
      mesh.wedges.push_back(
          {on_layer(a, l), on_layer(b, l), on_layer(c, l), on_layer(a, l + 1), on_layer(b, l + 1), on_layer(c, l + 1)});
    for (std::size_t k = 0; k < sizes.around; ++k) {
      const Index a = index(0, sizes.rings, k), b = index(0, sizes.rings, k + 1);
      mesh.boundary.push_back({{on_layer(a, l), on_layer(b, l), on_layer(b, l + 1), on_layer(a, l + 1)}, 1});
      mesh.boundary.push_back(
          {{on_layer(b + top, l), on_layer(a + top, l), on_layer(a + top, l + 1), on_layer(b + top, l + 1)}, 2});
    }
  }
  for (const auto& [a, b, c] : side)
    mesh.boundary.push_back(
        {{on_layer(a, sizes.layers), on_layer(b, sizes.layers), on_layer(c, sizes.layers), kNone}, 0});
  mesh.cell_region.assign(mesh.cell_count(), 0);
  return mesh;
}

}  // namespace vmesh::testing

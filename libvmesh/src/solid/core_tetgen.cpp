// TetGen (Hang Si, AGPL-3 or later): constrained Delaunay tetrahedra, refined where they are bad or large.
#define TETLIBRARY
#include <algorithm>
#include <array>
#include <climits>
#include <span>
#include <string>

#include <Eigen/Geometry>
#include <tetgen.h>

#include "vmesh/core/error.h"
#include "vmesh/solid/make_volume.h"

#include "solid/core.h"

namespace vmesh {
namespace {

// -p a surface, -Y kept as it is, -q radius by shortest edge and least dihedral angle, -m sizes, -o/ the dihedral angle
// above which cells are improved, -O how hard, -Q quiet.
// -q and -m are left out if that fails: refinement may run into rounding.
constexpr const char* kSwitches[] = {"pYQmq1.3/14o/140O9/7", "pYQmq2/0", "pYQ"};

constexpr const char* kSwitchesAround[] = {"pYQ"};

REAL* copied(const std::vector<Vec3>& points) {
  auto* coordinates = new REAL[3 * points.size()];  // tetgenio deletes them
  for (std::size_t v = 0; v < points.size(); ++v) std::copy_n(points[v].data(), 3, coordinates + 3 * v);
  return coordinates;
}

void set_surface(const TriMesh& mesh, tetgenio& in) {
  if (mesh.vertices.size() > INT_MAX / 4)
    throw Unsupported("the surface has too many vertices for tetrahedra: " + std::to_string(mesh.vertices.size()));
  in.numberofpoints = static_cast<int>(mesh.vertices.size());
  in.pointlist = copied(mesh.vertices);
  const std::vector<Triangle>& faces = mesh.faces;
  in.numberoffacets = static_cast<int>(faces.size());
  in.facetlist = new tetgenio::facet[faces.size()];
  for (std::size_t f = 0; f < faces.size(); ++f) {
    tetgenio::facet& facet = in.facetlist[f];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    facet.polygonlist->numberofvertices = 3;
    facet.polygonlist->vertexlist = new int[3];
    for (std::size_t i = 0; i < 3; ++i) facet.polygonlist->vertexlist[i] = static_cast<int>(faces[f][i]);
  }
}

void set_sizes(const std::vector<double>& size, tetgenio& in) {
  in.numberofpointmtrs = 1;
  in.pointmtrlist = new REAL[size.size()];
  std::copy(size.begin(), size.end(), in.pointmtrlist);
}

void take(const tetgenio& out, std::size_t given, Core& core) {
  for (std::size_t v = given; v < static_cast<std::size_t>(out.numberofpoints); ++v)
    core.added.emplace_back(out.pointlist[3 * v], out.pointlist[3 * v + 1], out.pointlist[3 * v + 2]);
  for (int t = 0; t < out.numberoftetrahedra; ++t) {
    const int* corner = out.tetrahedronlist + static_cast<std::ptrdiff_t>(t) * out.numberofcorners;
    core.tetrahedra.push_back({static_cast<Index>(corner[0]), static_cast<Index>(corner[1]),
                               static_cast<Index>(corner[2]), static_cast<Index>(corner[3])});
  }
}

// With a box around, half as large again.
TriMesh in_a_box(TriMesh mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.vertices) box.extend(p);
  const Vec3 margin = Vec3::Constant(0.25 * box.diagonal().norm());
  box.extend(box.max() + margin).extend(box.min() - margin);
  const auto n = static_cast<Index>(mesh.vertices.size());
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  // Corners are numbered by bits: x, y, z.
  for (const auto& [a, b, c, d] : {std::array{0, 1, 3, 2}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                                   std::array{2, 3, 7, 6}, std::array{0, 2, 6, 4}, std::array{1, 3, 7, 5}}) {
    mesh.faces.push_back({n + a, n + b, n + c});
    mesh.faces.push_back({n + a, n + c, n + d});
  }
  return mesh;
}

// With the first switches that do not fail. `fill` makes the input.
template <class Fill>
Core try_switches(std::span<const char* const> all_switches, const Fill& fill) {
  Core core;
  for (const char* switches : all_switches) {
    tetgenio in, out;
    fill(in);
    std::string words = switches;
    try {
      tetrahedralize(words.data(), &in, &out);
    } catch (const int code) {
      core.failure = "TetGen gave up with code " + std::to_string(code);
      continue;
    }
    core.failure.clear();
    take(out, static_cast<std::size_t>(in.numberofpoints), core);
    break;
  }
  return core;
}

}  // namespace

bool can_mesh_lumen() { return true; }

Core fill_core(const CoreSurface& surface) {
  return try_switches(kSwitches, [&](tetgenio& in) {
    set_surface(surface.mesh, in);
    set_sizes(surface.size, in);
  });
}

Core fill_around(const TriMesh& surfaces, const std::vector<Vec3>& within) {
  return try_switches(kSwitchesAround, [&](tetgenio& in) {
    set_surface(in_a_box(surfaces), in);
    in.numberofholes = static_cast<int>(within.size());
    in.holelist = copied(within);
  });
}

}  // namespace vmesh

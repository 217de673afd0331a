// TetGen (Hang Si, AGPL-3 or later): constrained Delaunay tetrahedra, refined where they are bad or large.
#define TETLIBRARY
#include <algorithm>
#include <climits>
#include <string>

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

void set_points(const CoreSurface& surface, tetgenio& in) {
  const std::vector<Vec3>& points = surface.mesh.vertices;
  in.numberofpoints = static_cast<int>(points.size());
  in.pointlist = new REAL[3 * points.size()];
  for (std::size_t v = 0; v < points.size(); ++v) std::copy_n(points[v].data(), 3, in.pointlist + 3 * v);
  in.numberofpointmtrs = 1;
  in.pointmtrlist = new REAL[points.size()];
  std::copy(surface.size.begin(), surface.size.end(), in.pointmtrlist);
}

void set_faces(const CoreSurface& surface, tetgenio& in) {
  const std::vector<Triangle>& faces = surface.mesh.faces;
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

void take(const tetgenio& out, std::size_t given, Core& core) {
  for (std::size_t v = given; v < static_cast<std::size_t>(out.numberofpoints); ++v)
    core.added.emplace_back(out.pointlist[3 * v], out.pointlist[3 * v + 1], out.pointlist[3 * v + 2]);
  for (int t = 0; t < out.numberoftetrahedra; ++t) {
    const int* corner = out.tetrahedronlist + static_cast<std::ptrdiff_t>(t) * out.numberofcorners;
    core.tetrahedra.push_back({static_cast<Index>(corner[0]), static_cast<Index>(corner[1]),
                               static_cast<Index>(corner[2]), static_cast<Index>(corner[3])});
  }
}

}  // namespace

bool can_mesh_lumen() { return true; }

Core fill_core(const CoreSurface& surface) {
  if (surface.mesh.vertices.size() > INT_MAX / 4)
    throw Unsupported("the surface has too many vertices for tetrahedra: " +
                      std::to_string(surface.mesh.vertices.size()));
  Core core;
  for (const char* switches : kSwitches) {
    tetgenio in, out;
    set_points(surface, in);
    set_faces(surface, in);
    std::string words = switches;
    try {
      tetrahedralize(words.data(), &in, &out);
    } catch (const int code) {
      core.failure = "TetGen gave up with code " + std::to_string(code);
      continue;
    }
    core.failure.clear();
    take(out, surface.mesh.vertices.size(), core);
    break;
  }
  return core;
}

}  // namespace vmesh

#include "fit/faces_beyond.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "vmesh/quality/closest_point.h"
#include "vmesh/quality/hausdorff.h"

namespace vmesh::fitting {
namespace {

constexpr double kTolerance = 1e-3;  // of the limit
constexpr int kFew = 4, kMany = 16;  // parts of a side between the points looked at: everywhere, beside a far one

FarPoint farthest_point(const TriMesh& mesh, Index f, const ClosestPointIndex& to, int parts) {
  const auto& [a, b, c] = mesh.faces[f];
  FarPoint farthest;
  Index near = kNone;
  for (int i = 0; i <= parts; ++i) {
    for (int j = 0; i + j <= parts; ++j) {
      const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts;
      const Vec3 p = (1 - u - v) * mesh.vertices[a] + u * mesh.vertices[b] + v * mesh.vertices[c];
      const ClosestPoint found = to.closest(p, near);
      near = found.face;
      if (found.distance > farthest.distance) farthest = {p, found.distance};
    }
  }
  return farthest;
}

std::vector<std::vector<Index>> faces_by_vertex(const TriMesh& mesh) {
  std::vector<std::vector<Index>> faces(mesh.vertices.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) faces[v].push_back(f);
  }
  return faces;
}

}  // namespace

std::vector<FarPoint> faces_beyond(const TriMesh& from, const TriMesh& to, double limit) {
  const ClosestPointIndex index(to);
  std::vector<FarPoint> far(from.faces.size());
  const auto look = [&](Index f, int parts) {
    const FarPoint farthest = farthest_point(from, f, index, parts);
    if (farthest.distance > limit) far[f] = farthest;
  };
  tbb::parallel_for(Index{0}, static_cast<Index>(far.size()), [&](Index f) { look(f, kFew); });
  const auto around = faces_by_vertex(from);
  HausdorffOptions options;
  options.tolerance = kTolerance * limit;
  while (true) {
    TriMesh rest{from.vertices, {}};
    std::vector<Index> number;  // in `from`
    for (Index f = 0; f < far.size(); ++f) {
      if (far[f].distance >= 0) continue;
      rest.faces.push_back(from.faces[f]);
      number.push_back(f);
    }
    if (rest.faces.empty()) return far;
    const auto witness = hausdorff_exceeds(rest, to, limit - options.tolerance, options);
    if (!witness) return far;
    const Index f = number[witness->from_face];
    far[f] = {witness->from, (witness->to - witness->from).norm()};
    for (const Index v : from.faces[f]) {
      for (const Index g : around[v]) {
        if (far[g].distance < 0) look(g, kMany);
      }
    }
  }
}

}  // namespace vmesh::fitting

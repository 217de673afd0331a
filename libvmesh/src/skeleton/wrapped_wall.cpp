#include "wrapped_wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include "vmesh/mesh/components.h"
#include "vmesh/mesh/topology.h"

#include "wall_cleaning.h"
#include "wall_probe.h"
#include "wall_text.h"

namespace vmesh::skeleton {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

// The largest ball that cannot enter: from this share of the extent, halved until it is this share of the vessels'
// mean radius; the wrap has about kFacesPerBall * area / ball^2 faces.
constexpr double kLargestBall = 1. / 8, kBallPerRadius = 1. / 4;
constexpr double kFacesPerBall = 10, kMostFaces = 60'000;
// Distance of the wrap from the faces, in balls.
constexpr double kOffset = 1. / 20;
// A wrap has entered the vessels where both sides of a face are outside, this number of offsets from it; if that is
// more than this share of the area, the wrap is too fine. That number of faces is asked.
constexpr double kBeside = 3, kEntered = 0.05;
constexpr std::size_t kAsked = 4000;
// Offsets by which vertices are moved back, at most.
constexpr double kLongestWay = 2;

struct Wrap {
  TriMesh mesh;
  double ball = 0, offset = 0;
  double radius = 0;  // 2 volume / area: the radius of a long tube
  double area = 0;
};

TriMesh to_mesh(const CGAL::Surface_mesh<Point>& surface) {
  TriMesh mesh;
  for (const auto v : surface.vertices()) {
    const Point& p = surface.point(v);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : surface.faces()) {
    Triangle face;
    std::size_t i = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f))) face[i++] = static_cast<Index>(v.idx());
    mesh.faces.push_back(face);
  }
  return mesh;
}

Wrap wrap_of(const TriMesh& soup, double ball) {
  std::vector<Point> points;
  std::vector<std::array<std::size_t, 3>> faces;
  for (const Vec3& p : soup.vertices) points.emplace_back(p.x(), p.y(), p.z());
  for (const auto& [a, b, c] : soup.faces) faces.push_back({a, b, c});
  CGAL::Surface_mesh<Point> surface;
  Wrap wrap;
  wrap.ball = ball;
  wrap.offset = kOffset * ball;
  CGAL::alpha_wrap_3(points, faces, ball, wrap.offset, surface);
  wrap.mesh = to_mesh(surface);
  for (Index f = 0; f < wrap.mesh.faces.size(); ++f) wrap.area += 0.5 * area_normal(wrap.mesh, f).norm();
  wrap.radius = wrap.area > 0 ? 2 * enclosed_volume(wrap.mesh) / wrap.area : 0;
  return wrap;
}

/// The share of the area, without what closes it, that is outside of the wrap on both sides.
double share_entered(const Wrap& wrap, const Shell& soup) {
  const TriMesh& mesh = soup.part.mesh;
  std::vector<Vec3> points;
  std::vector<double> areas;
  const std::size_t step = 1 + mesh.faces.size() / kAsked;
  for (Index f = 0; f < mesh.faces.size(); f += static_cast<Index>(step)) {
    const Vec3 normal = area_normal(mesh, f);
    if (soup.part.is_filling[f] || !(normal.norm() > 0)) continue;
    const auto& [a, b, c] = mesh.faces[f];
    const Vec3 middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
    for (const double side : {kBeside, -kBeside}) points.push_back(middle + side * wrap.offset * normal.normalized());
    areas.push_back(0.5 * normal.norm());
  }
  const std::vector<bool> inside = points_inside(wrap.mesh, points);
  double entered = 0, all = 0;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    all += areas[i];
    if (!inside[2 * i] && !inside[2 * i + 1]) entered += areas[i];
  }
  return all > 0 ? entered / all : 0;
}

/// The finest wrap that is worth it, or the last one before the wrap enters the vessels. Empty if the coarsest does.
Wrap finest_wrap(const Shell& soup, const Progress& progress) {
  Wrap best;
  for (double ball = kLargestBall * extent_of(soup.part.mesh);; ball /= 2) {
    report_progress(progress, "wrapping", 0.5);
    Wrap wrap = wrap_of(soup.part.mesh, ball);
    if (share_entered(wrap, soup) > kEntered) return best;
    best = std::move(wrap);
    const double faces = kFacesPerBall * best.area / (ball * ball / 4);
    if (ball <= kBallPerRadius * best.radius || faces > kMostFaces) return best;
  }
}

void move_back(Wrap& wrap, const WallProbe& soup) {
  for (Vec3& p : wrap.mesh.vertices) {
    const WallProbe::Nearest nearest = soup.nearest(p);
    if (nearest.distance <= kLongestWay * wrap.offset) p = nearest.point;
  }
}

/// Gives the faces the labels of the nearest ones of the soup, and the shell those ends that it has faces of.
void take_labels(Shell& shell, const Shell& soup, const WallProbe& probe) {
  const TriMesh& mesh = shell.part.mesh;
  std::vector<Index> number(soup.ends.size(), kNone);
  for (const auto& [a, b, c] : mesh.faces) {
    const Index near = probe.nearest((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3).face;
    Index end = soup.part.end_of_face[near];
    if (end != kNone) {
      if (number[end] == kNone) {
        number[end] = static_cast<Index>(shell.ends.size());
        shell.ends.push_back(soup.ends[end]);
      }
      end = number[end];
    }
    shell.part.end_of_face.push_back(end);
    shell.part.is_filling.push_back(soup.part.is_filling[near]);
  }
}

}  // namespace

WrappedWall wrapped(const Shell& soup, const Progress& progress) {
  Wrap wrap = finest_wrap(soup, progress);
  WrappedWall result;
  if (wrap.mesh.faces.empty()) {
    result.note = counted(soup.part.mesh.faces.size(), "face that bounds no volume is left out",
                          "faces that bound no volume are left out");
    return result;
  }
  const WallProbe probe(soup.part.mesh);
  move_back(wrap, probe);
  result.offset = wrap.offset;
  result.note = counted(soup.part.mesh.faces.size(), "face that bounds no volume by itself is wrapped",
                        "faces that bound no volume by themselves are wrapped") +
                ", gaps up to " + text(2 * wrap.ball) + " mm bridged; the wrap, " + text(wrap.offset) +
                " mm outside, is moved back onto them";
  for (TriMesh& mesh : split_components(wrap.mesh)) {
    Shell& shell = result.shells.emplace_back();
    shell.part.volume = enclosed_volume(mesh);
    shell.part.mesh = std::move(mesh);
    shell.part.wrapped = true;
    take_labels(shell, soup, probe);
  }
  return result;
}

}  // namespace vmesh::skeleton

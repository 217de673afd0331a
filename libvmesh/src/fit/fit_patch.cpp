#include "fit/fit_patch.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace vmesh::fitting {
namespace {

using Box = Eigen::AlignedBox3d;

std::vector<Index> vertices_within(const FitMesh& surface, Index face, double reach) {
  const Vec3 center = surface.position(surface.faces()[face][0]);
  std::vector<char> seen(surface.vertices().size(), 0);
  std::vector<Index> found, near;
  const auto add = [&](Index v) {
    if (seen[v]) return;
    seen[v] = 1;
    found.push_back(v);
  };
  for (const Index v : surface.faces()[face]) add(v);
  for (std::size_t i = 0; i < found.size(); ++i) {
    surface.neighbours(found[i], near);
    for (const Index v : near) {
      if ((surface.position(v) - center).norm() <= reach) add(v);
    }
  }
  return found;
}

Box box_of(const FitMesh& surface, Index f) {
  Box box;
  for (const Vec3& p : surface.corners(f)) box.extend(p);
  return box;
}

}  // namespace

bool FitPatch::moves(Index face) const {
  const Triangle& corners = surface.faces()[face];
  return std::any_of(corners.begin(), corners.end(), [&](Index v) { return !is_frozen(frozen, v); });
}

FitPatch patch_around(const FitMesh& whole, Index face, double reach) {
  const std::vector<Index> free = vertices_within(whole, face, reach);
  Box box;
  for (const Index v : free) {
    for (const Index f : whole.faces_around(v)) box.extend(box_of(whole, f));
  }
  const Vec3 room = Vec3::Constant(whole.mean_edge(whole.faces()[face][0]));  // for vertices to move
  box = Box(box.min() - room, box.max() + room);
  FitPatch patch;
  std::vector<Index> number(whole.vertices().size(), kNone);
  std::vector<Triangle> faces;
  std::vector<FitVertex> vertices;
  for (Index f = 0; f < whole.faces().size(); ++f) {
    if (!box.intersects(box_of(whole, f))) continue;
    Triangle corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index v = whole.faces()[f][i];
      if (number[v] == kNone) {
        number[v] = static_cast<Index>(patch.vertices.size());
        patch.vertices.push_back(v);
        vertices.push_back(whole.vertices()[v]);
      }
      corners[i] = number[v];
    }
    patch.faces.push_back(f);
    faces.push_back(corners);
  }
  patch.frozen.assign(vertices.size(), 1);
  for (const Index v : free) patch.frozen[number[v]] = 0;
  patch.surface = FitMesh(std::move(faces), std::move(vertices));
  return patch;
}

std::vector<Index> put_back(FitMesh& whole, const FitPatch& patch) {
  std::vector<Index> numbers = patch.vertices, faces = patch.faces;
  for (Index v = 0; v < patch.surface.vertices().size(); ++v) {
    if (v == numbers.size()) {
      numbers.push_back(whole.add_vertex(patch.surface.vertex(v)));
    } else {
      whole.edit(numbers[v]) = patch.surface.vertex(v);
    }
  }
  for (Index f = 0; f < patch.surface.faces().size(); ++f) {
    Triangle face = patch.surface.faces()[f];
    for (Index& v : face) v = numbers[v];
    if (f == faces.size()) {
      faces.push_back(whole.add_face(face));
    } else {
      whole.set_face(faces[f], face);
    }
  }
  return faces;
}

}  // namespace vmesh::fitting

#include "surface/proof/surface_excerpt.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

namespace vmesh {
namespace {

// For every face of the whole that is not in the excerpt.
template <class Visit>
void for_others(const SurfaceExcerpt& excerpt, const FinishedSurface& whole, const Visit& visit) {
  auto next = excerpt.face.begin();
  for (Index f = 0; f < whole.mesh.faces.size(); ++f) {
    if (next != excerpt.face.end() && *next == f) {
      ++next;
    } else {
      visit(whole.mesh.faces[f]);
    }
  }
}

}  // namespace

SurfaceExcerpt cut_out(const FinishedSurface& whole, const Vec3& center, double changed, double reach) {
  SurfaceExcerpt excerpt;
  FinishedSurface& surface = excerpt.surface;
  std::vector<Index> number(whole.mesh.vertices.size(), kNone);
  const auto add = [&](Index v) {
    if (number[v] != kNone) return number[v];
    excerpt.vertex.push_back(v);
    surface.mesh.vertices.push_back(whole.mesh.vertices[v]);
    surface.binding.push_back(whole.binding[v]);
    surface.radius.push_back(whole.radius[v]);
    return number[v] = static_cast<Index>(excerpt.vertex.size() - 1);
  };
  for (Index f = 0; f < whole.mesh.faces.size(); ++f) {
    const auto& [a, b, c] = whole.mesh.faces[f];
    Eigen::AlignedBox3d box(whole.mesh.vertices[a]);
    box.extend(whole.mesh.vertices[b]).extend(whole.mesh.vertices[c]);
    if (box.squaredExteriorDistance(center) > reach * reach) continue;
    excerpt.face.push_back(f);
    surface.mesh.faces.push_back({add(a), add(b), add(c)});
  }
  std::vector<char> held(excerpt.vertex.size(), 0);
  for (Index v = 0; v < held.size(); ++v) held[v] = (surface.mesh.vertices[v] - center).norm() > changed;
  const auto hold = [&](Index v) {
    if (number[v] != kNone) held[number[v]] = 1;
  };
  for_others(excerpt, whole, [&](const Triangle& face) { std::for_each(face.begin(), face.end(), hold); });
  std::for_each(whole.held.begin(), whole.held.end(), hold);
  for (const Opening& opening : whole.openings) std::for_each(opening.ring.begin(), opening.ring.end(), hold);
  for (Index v = 0; v < held.size(); ++v) {
    if (held[v]) surface.held.push_back(v);
  }
  return excerpt;
}

void put_in(FinishedSurface& whole, const SurfaceExcerpt& excerpt, const FinishedSurface& changed) {
  std::vector<Index> number(changed.mesh.vertices.size(), kNone);
  for (std::size_t i = 0; i < changed.held.size(); ++i)
    number[changed.held[i]] = excerpt.vertex[excerpt.surface.held[i]];
  for (Index v = 0; v < number.size(); ++v) {
    if (number[v] != kNone) continue;
    number[v] = static_cast<Index>(whole.mesh.vertices.size());
    whole.mesh.vertices.push_back(changed.mesh.vertices[v]);
    whole.binding.push_back(changed.binding[v]);
    whole.radius.push_back(changed.radius[v]);
  }
  std::vector<Triangle> faces;
  for_others(excerpt, whole, [&](const Triangle& face) { faces.push_back(face); });
  for (const auto& [a, b, c] : changed.mesh.faces) faces.push_back({number[a], number[b], number[c]});
  whole.mesh.faces = std::move(faces);
  put_back(finished_mesh(whole), whole);
}

}  // namespace vmesh

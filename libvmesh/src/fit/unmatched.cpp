#include "fit/unmatched.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "vmesh/core/disjoint_sets.h"

namespace vmesh {
namespace {

constexpr double kFar = 0.5;  // local radii

struct FarFace {
  Vec3 position = Vec3::Zero();
  double distance = -1;  // mm; negative: near
  double area = 0;
  bool inside = false;
  Index cone = kNone;
};

// Neighbours among the far faces are joined; across(f) lists the faces beside face f.
template <class Across>
std::vector<UnmatchedPart> parts_of(const std::vector<FarFace>& faces, Across&& across) {
  DisjointSets sets(faces.size());
  for (Index f = 0; f < faces.size(); ++f) {
    if (faces[f].distance < 0) continue;
    for (const Index g : across(f)) {
      if (g != kNone && faces[g].distance >= 0) sets.join(f, g);
    }
  }
  std::vector<Index> number(faces.size(), kNone);
  std::vector<UnmatchedPart> parts;
  for (Index f = 0; f < faces.size(); ++f) {
    if (faces[f].distance < 0) continue;
    Index& part = number[sets.find(f)];
    if (part == kNone) {
      part = static_cast<Index>(parts.size());
      parts.emplace_back();
    }
    UnmatchedPart& whole = parts[part];
    whole.area += faces[f].area;
    if (faces[f].distance < whole.distance) continue;
    whole.distance = faces[f].distance;
    whole.position = faces[f].position;
    whole.inside = faces[f].inside;
    whole.segment = faces[f].cone;
  }
  std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.area > b.area; });
  return parts;
}

// `normal(face)`: normal of a face of the other surface.
template <class Normal>
FarFace far_face(const Vec3& p, double area, Index cone, const ClosestPointIndex& to, const VesselField& field,
                 Normal&& normal) {
  const ClosestPoint found = to.closest(p);
  if (found.distance <= kFar * widest_radius(field, cone)) return {};
  return {p, found.distance, area, normal(found.face).dot(p - found.point) < 0, cone};
}

}  // namespace

std::vector<char> faces_apart(const Matches& matches, const std::vector<ReferenceSample>& samples,
                              const FitReference& reference) {
  const auto count = static_cast<Index>(reference.mesh().faces.size());
  DisjointSets sets(count);
  for (Index f = 0; f < count; ++f) {
    for (const Index g : reference.across(f)) {
      if (g != kNone) sets.join(f, g);
    }
  }
  std::vector<double> matched(count, 0), all(count, 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Index component = sets.find(samples[i].face);
    all[component] += samples[i].area;
    if (matches.from_reference[i].face != kNone) matched[component] += samples[i].area;
  }
  std::vector<char> apart(count);
  for (Index f = 0; f < count; ++f) {
    const Index component = sets.find(f);
    apart[f] = !(matched[component] > 0.5 * all[component]);
  }
  return apart;
}

std::vector<UnmatchedPart> uncovered_parts(const FitMesh& surface, const FitReference& reference,
                                           const VesselField& field) {
  const ClosestPointIndex index(surface.tri_mesh());
  std::vector<FarFace> faces(reference.mesh().faces.size());
  tbb::parallel_for(Index{0}, static_cast<Index>(faces.size()), [&](Index f) {
    faces[f] = far_face(reference.center(f), reference.area(f), reference.cone(f), index, field,
                        [&](Index g) { return surface.area_normal(g); });
  });
  return parts_of(faces, [&](Index f) { return reference.across(f); });
}

std::vector<UnmatchedPart> unsupported_parts(const FitMesh& surface, const FitReference& reference,
                                             const VesselField& field) {
  std::vector<FarFace> faces(surface.faces.size());
  tbb::parallel_for(Index{0}, static_cast<Index>(faces.size()), [&](Index f) {
    const auto [a, b, c] = surface.corners(f);
    faces[f] = far_face((a + b + c) / 3, surface.area_normal(f).norm() / 2, surface.vertices[surface.faces[f][0]].cone,
                        reference.index(), field, [&](Index g) { return reference.normal(g); });
  });
  return parts_of(faces, [&](Index f) {
    const Triangle& face = surface.faces[f];
    return Triangle{surface.face_of(face[1], face[0]), surface.face_of(face[2], face[1]),
                    surface.face_of(face[0], face[2])};
  });
}

}  // namespace vmesh

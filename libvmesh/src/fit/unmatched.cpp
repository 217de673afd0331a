#include "fit/unmatched.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/parallel_for.h>

#include "vmesh/core/disjoint_sets.h"

namespace vmesh::fitting {
namespace {

constexpr double kUnmatched = 0.5;    // local radii
constexpr double kInTriangle = 1e-9;  // of its area: what rounding adds to the parts into which a point divides it

// One interface to the faces of both surfaces.
struct FittedFaces {
  const FitMesh& surface;

  std::size_t count() const { return surface.faces().size(); }
  std::array<Vec3, 3> corners(Index f) const { return surface.corners(f); }
  Vec3 normal(Index f) const { return surface.unit_normal(f); }
  Triangle across(Index f) const {
    const Triangle& face = surface.faces()[f];
    return {surface.face_of(face[1], face[0]), surface.face_of(face[2], face[1]), surface.face_of(face[0], face[2])};
  }
};

struct ReferenceFaces {
  const FitReference& reference;

  std::size_t count() const { return reference.mesh().faces.size(); }
  std::array<Vec3, 3> corners(Index f) const {
    const auto& [a, b, c] = reference.mesh().faces[f];
    return {reference.mesh().vertices[a], reference.mesh().vertices[b], reference.mesh().vertices[c]};
  }
  Vec3 normal(Index f) const { return reference.normal(f); }
  const Triangle& across(Index f) const { return reference.across(f); }
};

struct FarFace {
  Vec3 position = Vec3::Zero();
  double distance = -1;  // mm; negative: near
  double area = 0;
  bool inside = false;
  bool unmatched = false;  // farther than half of the local radius
  Index cone = kNone;
};

void sort_by_area(std::vector<UnmatchedPart>& parts) {
  std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.area > b.area; });
}

// Neighbours among the far faces are joined.
template <class Faces>
FarParts parts_of(const std::vector<FarFace>& faces, const Faces& own) {
  DisjointSets sets(faces.size());
  for (Index f = 0; f < faces.size(); ++f) {
    if (faces[f].distance < 0) continue;
    for (const Index g : own.across(f)) {
      if (g != kNone && faces[g].distance >= 0) sets.join(f, g);
    }
  }
  std::vector<Index> number(faces.size(), kNone);
  std::vector<UnmatchedPart> parts;
  std::vector<char> is_unmatched;
  for (Index f = 0; f < faces.size(); ++f) {
    if (faces[f].distance < 0) continue;
    Index& part = number[sets.find(f)];
    if (part == kNone) {
      part = static_cast<Index>(parts.size());
      parts.emplace_back();
      is_unmatched.push_back(0);
    }
    if (faces[f].unmatched) is_unmatched[part] = 1;
    UnmatchedPart& whole = parts[part];
    whole.area += faces[f].area;
    if (faces[f].distance < whole.distance) continue;
    whole.distance = faces[f].distance;
    whole.position = faces[f].position;
    whole.inside = faces[f].inside;
    whole.segment = faces[f].cone;
  }
  FarParts result;
  for (std::size_t i = 0; i < parts.size(); ++i)
    (is_unmatched[i] ? result.unmatched : result.beyond).push_back(parts[i]);
  for (Index f = 0; f < faces.size(); ++f) {
    if (faces[f].distance >= 0 && is_unmatched[number[sets.find(f)]]) result.unmatched_faces.push_back(f);
  }
  sort_by_area(result.unmatched);
  sort_by_area(result.beyond);
  return result;
}

bool is_in_triangle(const std::array<Vec3, 3>& corners, const Vec3& p) {
  const auto& [a, b, c] = corners;
  const double parts = (a - p).cross(b - p).norm() + (b - p).cross(c - p).norm() + (c - p).cross(a - p).norm();
  return parts <= (1 + kInTriangle) * (b - a).cross(c - a).norm();
}

// Whether p lies behind the closest point. Of the faces that share that point, on an edge or corner, the one that looks
// at p or away from it the most decides: p can lie behind others of a ridge or tip although it is outside.
template <class Faces>
bool is_behind(const Vec3& p, const ClosestPoint& closest, const Faces& faces) {
  std::vector<Index> sharing = {closest.face};
  double most = 0;
  for (std::size_t i = 0; i < sharing.size(); ++i) {
    const double height = faces.normal(sharing[i]).dot(p - closest.point);
    if (std::abs(height) > std::abs(most)) most = height;
    for (const Index g : faces.across(sharing[i])) {
      if (g == kNone || std::find(sharing.begin(), sharing.end(), g) != sharing.end()) continue;
      if (is_in_triangle(faces.corners(g), closest.point)) sharing.push_back(g);
    }
  }
  return most < 0;
}

// `beyond`: its farthest point, if that is beyond a limit.
template <class Faces>
FarFace far_face(const Vec3& center, double area, Index cone, const FarPoint& beyond, const ClosestPointIndex& to,
                 const Faces& others, const VesselField& field) {
  const double distance = to.closest(center).distance;
  const bool unmatched = distance > kUnmatched * widest_radius(field, cone);
  if (!unmatched && beyond.distance < 0) return {};
  const Vec3& p = beyond.distance > distance ? beyond.position : center;
  const ClosestPoint found = to.closest(p);
  return {p, found.distance, area, is_behind(p, found, others), unmatched, cone};
}

FarPoint at(const std::vector<FarPoint>& beyond, Index face) { return beyond.empty() ? FarPoint{} : beyond[face]; }

TriMesh part_of(const TriMesh& mesh, const std::vector<Index>& faces) {
  TriMesh part{mesh.vertices, {}};
  for (const Index f : faces) part.faces.push_back(mesh.faces[f]);
  return part;
}

// Takes for unmatched what is beyond the limit because of what is unmatched of the other surface, as the mouth of a
// missing twig. `others`: that surface's unmatched faces.
void take_mouths(FarParts& parts, const TriMesh& others, double limit) {
  if (others.faces.empty() || parts.beyond.empty()) return;
  const ClosestPointIndex index(others);
  std::vector<UnmatchedPart> left;
  for (const UnmatchedPart& part : parts.beyond) {
    const bool is_mouth = index.closest(part.position).distance < part.distance + limit;
    (is_mouth ? parts.unmatched : left).push_back(part);
  }
  parts.beyond = std::move(left);
  sort_by_area(parts.unmatched);
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

FarParts uncovered_parts(const FitMesh& surface, const FitReference& reference, const VesselField& field,
                         const std::vector<FarPoint>& beyond) {
  const ClosestPointIndex index(surface.tri_mesh());
  const ReferenceFaces own{reference};
  const FittedFaces others{surface};
  std::vector<FarFace> faces(own.count());
  tbb::parallel_for(Index{0}, static_cast<Index>(faces.size()), [&](Index f) {
    faces[f] = far_face(reference.center(f), reference.area(f), reference.cone(f), at(beyond, f), index, others, field);
  });
  return parts_of(faces, own);
}

FarParts unsupported_parts(const FitMesh& surface, const FitReference& reference, const VesselField& field,
                           const std::vector<FarPoint>& beyond) {
  const FittedFaces own{surface};
  const ReferenceFaces others{reference};
  std::vector<FarFace> faces(own.count());
  tbb::parallel_for(Index{0}, static_cast<Index>(faces.size()), [&](Index f) {
    const auto [a, b, c] = surface.corners(f);
    faces[f] =
        far_face((a + b + c) / 3, surface.area_normal(f).norm() / 2, surface.vertices()[surface.faces()[f][0]].cone,
                 at(beyond, f), reference.index(), others, field);
  });
  return parts_of(faces, own);
}

void find_far(FitReport& report, const FitMesh& surface, const FitReference& reference, const VesselField& field,
              double max_error) {
  const TriMesh mesh = surface.tri_mesh();
  std::vector<FarPoint> from_reference, from_surface;
  if (max_error > 0) {
    from_reference = faces_beyond(reference.mesh(), mesh, max_error);
    from_surface = faces_beyond(mesh, reference.mesh(), max_error);
  }
  FarParts uncovered = uncovered_parts(surface, reference, field, from_reference);
  FarParts unsupported = unsupported_parts(surface, reference, field, from_surface);
  take_mouths(uncovered, part_of(mesh, unsupported.unmatched_faces), max_error);
  take_mouths(unsupported, part_of(reference.mesh(), uncovered.unmatched_faces), max_error);
  report.uncovered = std::move(uncovered.unmatched);
  report.unsupported = std::move(unsupported.unmatched);
  report.beyond = std::move(uncovered.beyond);
  report.beyond.insert(report.beyond.end(), unsupported.beyond.begin(), unsupported.beyond.end());
  sort_by_area(report.beyond);
}

}  // namespace vmesh::fitting

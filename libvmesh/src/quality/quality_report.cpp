#include "vmesh/quality/quality_report.h"

#include <string>

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

[[noreturn]] void refuse(std::size_t face, Index vertex, const char* why) {
  throw InvalidInput("face " + std::to_string(face) + ", vertex " + std::to_string(vertex) + ": " + why);
}

void check_faces(const TriMesh& mesh) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) {
      if (v >= mesh.vertices.size()) refuse(f, v, "there is no such vertex");
      if (!mesh.vertices[v].allFinite()) refuse(f, v, "a coordinate is not a finite number");
    }
  }
}

Vec3 center_of(const TriMesh& mesh, Index face) {
  const auto& [a, b, c] = mesh.faces[face];
  return (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
}

std::map<Index, std::size_t> count_valences(const TriMesh& mesh) {
  std::map<Index, std::size_t> vertices;
  for (const Index valence : valences(mesh)) {
    if (valence > 0) ++vertices[valence];
  }
  return vertices;
}

std::vector<IntersectingFaces> intersecting_faces(const TriMesh& mesh) {
  std::vector<IntersectingFaces> pairs;
  for (const auto& [f, g] : self_intersections(mesh))
    pairs.push_back({f, g, 0.5 * (center_of(mesh, f) + center_of(mesh, g))});
  return pairs;
}

}  // namespace

FaceMeasures measure_faces(const TriMesh& mesh) {
  check_faces(mesh);
  FaceMeasures all;
  for_each_face_measure(
      all, [&](const char*, std::vector<double>& values, double, double) { values.resize(mesh.faces.size()); });
  tbb::parallel_for(std::size_t{0}, mesh.faces.size(), [&](std::size_t f) {
    const auto& [a, b, c] = mesh.faces[f];
    const TriangleMeasures one = measure_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    all.area_mm2[f] = one.area_mm2;
    all.min_angle_deg[f] = one.min_angle_deg;
    all.max_angle_deg[f] = one.max_angle_deg;
    all.equiangle_skewness[f] = one.equiangle_skewness;
    all.shortest_to_longest_edge[f] = one.shortest_to_longest_edge;
    all.double_inradius_to_circumradius[f] = one.double_inradius_to_circumradius;
    all.scaled_inradius_to_longest_edge[f] = one.scaled_inradius_to_longest_edge;
  });
  return all;
}

DefectReport find_defects(const TriMesh& mesh) {
  check_faces(mesh);
  DefectReport report;
  tbb::parallel_invoke([&] { report.topology = measure_topology(mesh); },
                       [&] { report.degenerate_faces = degenerate_faces(mesh); },
                       [&] { report.duplicate_faces = duplicate_faces(mesh); },
                       [&] { report.vertices_of_valence = count_valences(mesh); },
                       [&] { report.self_intersections = intersecting_faces(mesh); });
  return report;
}

}  // namespace vmesh

#include "fit/fit_reference.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

#include <tbb/parallel_for.h>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/mesh/topology.h"

namespace vmesh::fitting {
namespace {

constexpr double kBulge = 1;        // local radii from the round cones: as far as bulges go
constexpr double kSharpEdge = 0.7;  // largest cosine between the normals on both sides of a sharp edge
// Roberts' R2, as in sample_surface().
constexpr double kPlastic = 1.32471795724474602596;

struct HalfEdge {
  Index from, to, face;
  int side;

  bool operator<(const HalfEdge& other) const { return key() < other.key(); }
  std::array<Index, 3> key() const { return {std::min(from, to), std::max(from, to), face}; }
};

// Merges coincident vertices; removes faces that lose their area by that.
TriMesh welded(const TriMesh& mesh) {
  std::vector<Index> order(mesh.vertices.size()), number(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](Index v) {
    const Vec3& p = mesh.vertices[v];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(), [&](Index v, Index w) { return std::pair(key(v), v) < std::pair(key(w), w); });
  for (std::size_t i = 0; i < order.size(); ++i)
    number[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? number[order[i - 1]] : order[i];
  TriMesh result{mesh.vertices, {}};
  for (const auto& [a, b, c] : mesh.faces) {
    const Triangle face{number[a], number[b], number[c]};
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) result.faces.push_back(face);
  }
  return result;
}

}  // namespace

double widest_radius(const VesselField& field, Index cone) {
  return std::max(field.relations().radius_at(cone, 0), field.relations().radius_at(cone, 1));
}

bool same_vessel(const VesselField& field, Index a, Index b) {
  const auto local = field.relations().local_cones(a);
  return std::binary_search(local.begin(), local.end(), b);
}

FitReference::FitReference(const TriMesh& mesh, const VesselField& field) : mesh_(welded(mesh)) {
  if (mesh_.faces.empty()) throw InvalidInput("the reference has no faces");
  connect();
  turn_outwards(field);
  index_.emplace(mesh_);
  normals_.reserve(mesh_.faces.size());
  for (Index f = 0; f < mesh_.faces.size(); ++f) {
    const Vec3 normal = area_normal(mesh_, f);
    const double norm = normal.norm();
    normals_.push_back(norm > 0 ? Vec3(normal / norm) : Vec3(Vec3::Zero()));
  }
  find_cones(field);
  find_near(field);
}

void FitReference::connect() {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh_.faces.size());
  for (Index f = 0; f < mesh_.faces.size(); ++f) {
    for (int i = 0; i < 3; ++i) edges.push_back({mesh_.faces[f][i], mesh_.faces[f][(i + 1) % 3], f, i});
  }
  std::sort(edges.begin(), edges.end());
  across_.assign(mesh_.faces.size(), {kNone, kNone, kNone});
  const auto same_edge = [](const HalfEdge& a, const HalfEdge& b) {
    return std::minmax(a.from, a.to) == std::minmax(b.from, b.to);
  };
  for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
    while (end < edges.size() && same_edge(edges[first], edges[end])) ++end;
    if (end - first != 2) continue;  // a border, or an edge of more than two faces
    const HalfEdge &a = edges[first], &b = edges[first + 1];
    if (a.from == b.from)
      throw InvalidInput("the faces of the reference disagree about the outside, at " +
                         point_text(mesh_.vertices[a.from]) + "; orient them first");
    across_[a.face][a.side] = b.face;
    across_[b.face][b.side] = a.face;
  }
}

// Decides for a closed reference by the volume it encloses, for an open one by the vessels that it surrounds.
void FitReference::turn_outwards(const VesselField& field) {
  const bool closed = std::all_of(across_.begin(), across_.end(), [](const Triangle& sides) {
    return std::find(sides.begin(), sides.end(), kNone) == sides.end();
  });
  double outward = 0;
  if (closed) {
    outward = enclosed_volume(mesh_);
  } else {
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      const FieldSample sample = field.sample_global(center(f));
      if (std::abs(sample.distance) < widest_radius(field, sample.cone))
        outward += sample.gradient.dot(area_normal(mesh_, f));
    }
  }
  turned_ = outward < 0;
  if (!turned_) return;
  for (Triangle& face : mesh_.faces) std::swap(face[1], face[2]);
  for (Triangle& sides : across_) std::swap(sides[0], sides[2]);
}

Vec3 FitReference::center(Index f) const {
  const auto& [a, b, c] = mesh_.faces[f];
  return (mesh_.vertices[a] + mesh_.vertices[b] + mesh_.vertices[c]) / 3;
}

double FitReference::area(Index f) const { return area_normal(mesh_, f).norm() / 2; }

// Where the nearest cone faces the same way, it is the vessel's; elsewhere it may be a neighbour's, and the cone is
// found from the surroundings.
void FitReference::find_cones(const VesselField& field) {
  cones_.resize(mesh_.faces.size());
  std::vector<char> known(mesh_.faces.size());
  tbb::parallel_for(Index{0}, static_cast<Index>(mesh_.faces.size()), [&](Index f) {
    const FieldSample sample = field.sample_global(center(f));
    cones_[f] = sample.cone;
    known[f] = sample.gradient.dot(normals_[f]) > 0;
  });
  std::vector<Index> queue;
  for (Index f = 0; f < known.size(); ++f) {
    if (known[f]) queue.push_back(f);
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (const Index g : across_[queue[i]]) {
      if (g == kNone || known[g]) continue;
      known[g] = 1;
      cones_[g] = field.sample(center(g), cones_[queue[i]]).cone;
      queue.push_back(g);
    }
  }
}

void FitReference::find_near(const VesselField& field) {
  near_.resize(mesh_.faces.size());
  tbb::parallel_for(Index{0}, static_cast<Index>(mesh_.faces.size()), [&](Index f) {
    near_[f] = field.sample(center(f), cones_[f]).distance <= kBulge * widest_radius(field, cones_[f]);
  });
}

bool FitReference::on_border(Index f, const Vec3& p) const {
  for (int i = 0; i < 3; ++i) {
    if (across_[f][i] != kNone) continue;
    const Vec3 &a = mesh_.vertices[mesh_.faces[f][i]], &b = mesh_.vertices[mesh_.faces[f][(i + 1) % 3]];
    const Vec3 edge = b - a;
    if (edge.cross(p - a).squaredNorm() <= 1e-12 * edge.squaredNorm() * edge.squaredNorm()) return true;
  }
  return false;
}

std::vector<ReferenceSample> FitReference::samples(const VesselField& field, std::size_t count) const {
  std::vector<double> share(mesh_.faces.size());
  double total = 0;
  for (Index f = 0; f < share.size(); ++f) {
    const double radius = widest_radius(field, cones_[f]);
    total += share[f] = area(f) / (radius * radius);
  }
  std::vector<ReferenceSample> samples;
  samples.reserve(count);
  const double step = total / static_cast<double>(count);
  double sum = 0, next = 0.5;
  for (Index f = 0; f < share.size(); ++f) {
    sum += share[f];
    for (; (next * step) < sum; ++next) {
      const double number = static_cast<double>(samples.size());
      double u = std::fmod(0.5 + number / kPlastic, 1), v = std::fmod(0.5 + number / (kPlastic * kPlastic), 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const auto& [a, b, c] = mesh_.faces[f];
      const Vec3 p = (1 - u - v) * mesh_.vertices[a] + u * mesh_.vertices[b] + v * mesh_.vertices[c];
      const double radius = widest_radius(field, cones_[f]);
      samples.push_back({p, f, step * radius * radius});
    }
  }
  return samples;
}

std::vector<ReferenceSample> FitReference::rim_samples() const {
  std::vector<ReferenceSample> samples;
  for (Index f = 0; f < mesh_.faces.size(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const Index g = across_[f][i];
      if (g == kNone || normals_[f].dot(normals_[g]) > kSharpEdge) continue;
      const Vec3 &a = mesh_.vertices[mesh_.faces[f][i]], &b = mesh_.vertices[mesh_.faces[f][(i + 1) % 3]];
      samples.push_back({a, f, 0});
      samples.push_back({0.5 * (a + b), f, 0});
    }
  }
  return samples;
}

}  // namespace vmesh::fitting

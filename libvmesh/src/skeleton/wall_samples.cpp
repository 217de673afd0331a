#include "wall_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "vmesh/core/memory.h"
#include "vmesh/mesh/check_indices.h"

namespace vmesh::skeleton {
namespace {

constexpr double kBytesPerSample = 2 * (2 * sizeof(Vec3) + sizeof(double) + sizeof(Index));  // vectors grow by doubling

/// A triangle as two right triangles on either side of the height on its longest edge.
struct Halves {
  Vec3 start, along, up;  // one end of the longest edge; unit
  double first, second;   // lengths of the longest edge up to the height and behind it
  double height;
};

Halves halves_of(const TriMesh& mesh, Index f) {
  const Triangle& face = mesh.faces[f];
  std::array<double, 3> lengths;
  for (std::size_t i = 0; i < 3; ++i) lengths[i] = (mesh.vertices[face[(i + 1) % 3]] - mesh.vertices[face[i]]).norm();
  const auto longest = static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
  const Vec3 &a = mesh.vertices[face[longest]], &b = mesh.vertices[face[(longest + 1) % 3]],
             &c = mesh.vertices[face[(longest + 2) % 3]];
  Halves halves;
  halves.start = a;
  halves.along = lengths[longest] > 0 ? Vec3((b - a) / lengths[longest]) : Vec3(Vec3::Zero());  // else it has no area
  halves.first = std::clamp((c - a).dot(halves.along), 0.0, lengths[longest]);
  halves.second = lengths[longest] - halves.first;
  const Vec3 up = c - a - (c - a).dot(halves.along) * halves.along;
  halves.height = up.norm();
  halves.up = halves.height > 0 ? Vec3(up / halves.height) : Vec3(Vec3::Zero());
  return halves;
}

std::size_t pieces_of(double length, double spacing) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(length / spacing * (1 - 1e-12))));
}

/// Calls take(along, up, area) for the pieces of a right triangle with its sharp corner at 0: columns across its
/// length, each divided evenly.
template <class Take>
void divide(double length, double height, double spacing, Take&& take) {
  if (!(length > 0 && height > 0)) return;
  const std::size_t columns = pieces_of(length, spacing);
  const double width = length / static_cast<double>(columns);
  for (std::size_t i = 0; i < columns; ++i) {
    const double from = static_cast<double>(i) * width, low = height * from / length, rise = height * width / length;
    const std::size_t rows = pieces_of(low + rise / 2, spacing);
    const double share = 1 / static_cast<double>(rows);
    const double area = width * (low + rise / 2) * share;
    // Centroid of a trapezoid, in its width from the lower side; its pieces have the same.
    const double t = (low / 2 + rise / 3) / (low + rise / 2);
    // The mean of the height over the trapezoid, as seen from its centroid: pieces are bounded by straight lines.
    const double mean = (low * low + low * rise + rise * rise / 3) / (low + rise / 2);
    for (std::size_t j = 0; j < rows; ++j) take(from + t * width, mean * (static_cast<double>(j) + 0.5) * share, area);
  }
}

class Sampler {
 public:
  explicit Sampler(const TriMesh& mesh) : mesh_(mesh) {}

  void sample(Index f, double spacing) {
    const Vec3 normal = area_normal(mesh_, f);
    const double area = 0.5 * normal.norm();
    if (!(area > 0) || !(spacing > 0)) return;
    const Halves halves = halves_of(mesh_, f);
    const std::size_t first = samples_.points.size();
    if (halves.first + halves.second <= spacing) {
      const auto& [a, b, c] = mesh_.faces[f];
      add(f, (mesh_.vertices[a] + mesh_.vertices[b] + mesh_.vertices[c]) / 3, area, normal / (2 * area));
      return;
    }
    const auto take = [&](double along, double up, double piece) {
      add(f, halves.start + along * halves.along + up * halves.up, piece, normal / (2 * area));
    };
    divide(halves.first, halves.height, spacing, take);
    divide(halves.second, halves.height, spacing,
           [&](double along, double up, double piece) { take(halves.first + halves.second - along, up, piece); });
    // Rounding must not add or lose area.
    const double sum =
        std::accumulate(samples_.areas.begin() + static_cast<std::ptrdiff_t>(first), samples_.areas.end(), 0.0);
    for (std::size_t i = first; i < samples_.areas.size(); ++i) samples_.areas[i] *= area / sum;
  }

  WallSamples take() { return std::move(samples_); }

 private:
  void add(Index f, const Vec3& point, double area, const Vec3& normal) {
    samples_.points.push_back(point);
    samples_.normals.push_back(normal);
    samples_.areas.push_back(area);
    samples_.faces.push_back(f);
  }

  const TriMesh& mesh_;
  WallSamples samples_;
};

/// About how many samples a face has, at most.
double expected(const TriMesh& mesh, Index f, double spacing) {
  if (!(spacing > 0)) return 0;
  const Halves halves = halves_of(mesh, f);
  const double columns = 2 + (halves.first + halves.second) / spacing;
  return columns * (1 + halves.height / spacing / 2);
}

}  // namespace

WallSamples samples_by_area(const TriMesh& mesh, const std::function<double(Index face)>& spacing) {
  check_indices(mesh);
  std::vector<double> spacings;
  double count = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    spacings.push_back(spacing(f));
    count += expected(mesh, f, spacings.back());
  }
  require_memory(kBytesPerSample * count, "sampling the wall", "sample it more coarsely");
  Sampler sampler(mesh);
  for (Index f = 0; f < mesh.faces.size(); ++f) sampler.sample(f, spacings[f]);
  return sampler.take();
}

namespace {

/// Unit normals of the vertices, weighted by the faces' angles there, which do not depend on how the wall is cut into
/// triangles; zero where there is no wall.
std::vector<Vec3> normals_by_angle(const TriMesh& mesh, const std::function<bool(Index face)>& is_wall) {
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Vec3 normal = area_normal(mesh, f);
    if (!is_wall(f) || !(normal.norm() > 0)) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& at = mesh.vertices[mesh.faces[f][i]];
      const Vec3 first = mesh.vertices[mesh.faces[f][(i + 1) % 3]] - at;
      const Vec3 second = mesh.vertices[mesh.faces[f][(i + 2) % 3]] - at;
      const double angle = std::atan2(first.cross(second).norm(), first.dot(second));
      normals[mesh.faces[f][i]] += angle * normal.normalized();
    }
  }
  for (Vec3& normal : normals)
    if (const double norm = normal.norm(); norm > 0) normal /= norm;
  return normals;
}

}  // namespace

void move_onto_smooth_wall(WallSamples& samples, const TriMesh& mesh, const std::function<bool(Index face)>& is_wall) {
  constexpr double kShare = 0.5, kLeastCosine = 0.5;
  const std::vector<Vec3> normals = normals_by_angle(mesh, is_wall);
  for (std::size_t s = 0; s < samples.points.size(); ++s) {
    const Triangle& face = mesh.faces[samples.faces[s]];
    const Vec3 point = samples.points[s], normal = area_normal(mesh, samples.faces[s]);
    const double twice_area = normal.norm();
    Vec3 move = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& of_vertex = normals[face[i]];
      if (of_vertex.dot(normal) < kLeastCosine * twice_area) continue;
      const Vec3 first = mesh.vertices[face[(i + 1) % 3]] - point, second = mesh.vertices[face[(i + 2) % 3]] - point;
      const double share = first.cross(second).norm() / twice_area;
      move += kShare * share * (mesh.vertices[face[i]] - point).dot(of_vertex) * of_vertex;
    }
    samples.points[s] += move;
  }
}

}  // namespace vmesh::skeleton

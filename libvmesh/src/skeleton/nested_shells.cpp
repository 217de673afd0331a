#include "nested_shells.h"

#include <algorithm>

#include "vmesh/core/box_tree.h"
#include "vmesh/mesh/topology.h"

#include "wall_text.h"

namespace vmesh::skeleton {
namespace {

// Less than this share of the largest volume, or thinner than this relative to its extent: debris.
constexpr double kLeastVolume = 1e-5, kThinnest = 1e-5;
// The inner surface of a wall has at least this share of the outer's volume.
constexpr double kLumen = 0.25;
// If there are several, each has at least this share of their volume.
constexpr double kSmallestLumen = 0.02;
// Of these many vertices, most decide whether a shell is within another.
constexpr std::size_t kWitnesses = 5;

struct Bounds {
  Vec3 low, high;

  bool contains(const Bounds& other) const {
    return (low.array() <= other.low.array()).all() && (high.array() >= other.high.array()).all();
  }
};

Bounds bounds_of(const TriMesh& mesh) {
  Bounds bounds{mesh.vertices.front(), mesh.vertices.front()};
  for (const Vec3& p : mesh.vertices) {
    bounds.low = bounds.low.cwiseMin(p);
    bounds.high = bounds.high.cwiseMax(p);
  }
  return bounds;
}

bool is_flat(const Shell& shell) {
  double area = 0;
  const TriMesh& mesh = shell.part.mesh;
  for (Index f = 0; f < mesh.faces.size(); ++f) area += 0.5 * area_normal(mesh, f).norm();
  const Bounds bounds = bounds_of(mesh);
  return !(2 * shell.part.volume > kThinnest * area * (bounds.high - bounds.low).norm());
}

void drop_debris(std::vector<Shell>& shells, std::vector<std::string>& notes) {
  const std::size_t before = shells.size();
  const double least = shells.empty() ? 0 : kLeastVolume * shells.front().part.volume;
  std::erase_if(shells, [&](const Shell& shell) { return !(shell.part.volume > least) || is_flat(shell); });
  if (shells.size() < before) {
    notes.push_back(counted(before - shells.size(), "component with almost no volume is left out",
                            "components with almost no volume are left out"));
  }
}

/// Those of the candidates that are within a shell.
std::vector<std::size_t> within(const std::vector<Shell>& shells, const Shell& outer,
                                const std::vector<std::size_t>& candidates) {
  std::vector<Vec3> witnesses;
  for (const std::size_t i : candidates) {
    const std::vector<Vec3>& vertices = shells[i].part.mesh.vertices;
    for (std::size_t k = 0; k < kWitnesses; ++k) witnesses.push_back(vertices[k * (vertices.size() - 1) / kWitnesses]);
  }
  std::vector<std::size_t> found;
  if (candidates.empty()) return found;
  const std::vector<bool> inside = points_inside(outer.part.mesh, witnesses);
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const auto first = inside.begin() + static_cast<std::ptrdiff_t>(c * kWitnesses);
    if (2 * std::count(first, first + kWitnesses, true) > static_cast<std::ptrdiff_t>(kWitnesses))
      found.push_back(candidates[c]);
  }
  return found;
}

/// The smallest shell around each; its own number without one.
std::vector<std::size_t> parents_of(const std::vector<Shell>& shells) {
  std::vector<Bounds> bounds;
  std::vector<Vec3> low, high;
  std::vector<std::size_t> parent;
  for (const Shell& shell : shells) {
    bounds.push_back(bounds_of(shell.part.mesh));
    low.push_back(bounds.back().low);
    high.push_back(bounds.back().high);
    parent.push_back(parent.size());
  }
  const BoxTree tree(low, high);
  // By volume, largest first: the last one around a shell is the smallest.
  for (std::size_t outer = 0; outer < shells.size(); ++outer) {
    std::vector<std::size_t> candidates;
    tree.visit_overlapping(low[outer], high[outer], [&](Index i) {
      if (i > outer && bounds[outer].contains(bounds[i])) candidates.push_back(i);
    });
    std::sort(candidates.begin(), candidates.end());
    for (const std::size_t i : within(shells, shells[outer], candidates)) parent[i] = outer;
  }
  return parent;
}

std::string note_on_cavities(const std::vector<Shell>& shells, const std::vector<std::size_t>& cavities) {
  const WallPart& largest = shells[cavities.front()].part;
  const Bounds bounds = bounds_of(largest.mesh);
  const Vec3 middle = 0.5 * (bounds.low + bounds.high);
  return counted(cavities.size(), "cavity is left out, ", "cavities are left out, the largest ") +
         text(largest.volume) + " mm^3 at " + text(middle);
}

}  // namespace

void keep_lumens(std::vector<Shell>& shells, std::vector<std::string>& notes) {
  std::stable_sort(shells.begin(), shells.end(),
                   [](const Shell& a, const Shell& b) { return a.part.volume > b.part.volume; });
  drop_debris(shells, notes);
  const std::vector<std::size_t> parent = parents_of(shells);
  std::vector<double> inner(shells.size(), 0);  // volume of the shells right inside
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (parent[i] != i) inner[parent[i]] += shells[i].part.volume;
  }
  const auto is_thick_wall = [&](std::size_t i) { return inner[i] >= kLumen * shells[i].part.volume; };
  const auto is_lumen_of = [&](std::size_t i, std::size_t wall) {
    return is_thick_wall(wall) && shells[i].part.volume >= kSmallestLumen * inner[wall];
  };
  std::vector<bool> kept(shells.size()), is_cavity(shells.size(), false);
  std::vector<std::size_t> cavities;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    is_cavity[i] = parent[i] != i && (is_cavity[parent[i]] || !is_lumen_of(i, parent[i]));
    kept[i] = !is_cavity[i] && !is_thick_wall(i);
    if (is_cavity[i]) {
      cavities.push_back(i);
    } else if (is_thick_wall(i)) {
      notes.push_back("the outer surface of a wall with a thickness, " + text(shells[i].part.volume) +
                      " mm^3, is left out; its inner surface, " + text(inner[i]) + " mm^3, is taken");
    }
  }
  if (!cavities.empty()) notes.push_back(note_on_cavities(shells, cavities));
  std::vector<Shell> lumens;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    if (kept[i]) lumens.push_back(std::move(shells[i]));
  }
  shells = std::move(lumens);
}

}  // namespace vmesh::skeleton

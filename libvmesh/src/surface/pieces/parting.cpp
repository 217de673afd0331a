#include "surface/pieces/parting.h"

#include <algorithm>

#include "vmesh/core/box_tree.h"

#include "surface/proof/patch.h"

namespace vmesh {
namespace {

using FacePair = std::pair<Index, Index>;

// Equiangle skewness that a step may leave: pieces are mended above it; safe 0.35 to 0.7.
constexpr double kWorstLeft = 0.5;
// Least cosine between the normals of a face and of the boundary that a step may leave; idle 0.21 to 0.42.
constexpr double kUpright = 0.3;
// Where an edge may be split, from its midpoint, in edge lengths; idle 0.1 and 0.21 to 0.21 and 0.42.
constexpr double kSlides[] = {0, 0.15, -0.15, 0.3, -0.3};

struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  bool holds(const Vec3& p) const { return (p.array() >= low.array()).all() && (p.array() <= high.array()).all(); }
};

PlacedFace placed(const TriMesh& mesh, Index f) {
  const Triangle& face = mesh.faces[f];
  return {face, {mesh.vertices[face[0]], mesh.vertices[face[1]], mesh.vertices[face[2]]}};
}

// The neighbourhood of crossing faces as a surface of its own, with its numbers in the whole surface.
struct Neighbourhood {
  FinishedSurface surface;
  std::vector<Index> vertex, face;
  std::vector<Box> box;  // bounds what one step at a pair of crossing faces may change
};

class NeighbourhoodMaker {
 public:
  NeighbourhoodMaker(const GatheredSurface& whole, const std::vector<FacePair>& crossings)
      : whole_(whole), crossings_(crossings) {}

  Neighbourhood run() {
    find_boxes();
    std::vector<Vec3> low, high;
    for (const Box& box : around_.box) {
      low.push_back(box.low);
      high.push_back(box.high);
    }
    const BoxTree tree(low, high);
    std::vector<Index> number(whole_.mesh.vertices.size(), kNone);
    for (Index f = 0; f < whole_.mesh.faces.size(); ++f) {
      Box box;
      for (const Index v : whole_.mesh.faces[f]) box.add(whole_.mesh.vertices[v]);
      bool near = false;
      tree.visit_overlapping(box.low, box.high, [&](Index) { near = true; });
      if (near) add(f, number);
    }
    return std::move(around_);
  }

 private:
  // Boxes around the faces that touch each crossing pair.
  void find_boxes() {
    std::vector<std::pair<Index, Index>> pair_at;  // by vertex
    for (Index i = 0; i < crossings_.size(); ++i) {
      for (const Index f : {crossings_[i].first, crossings_[i].second}) {
        for (const Index v : whole_.mesh.faces[f]) pair_at.emplace_back(v, i);
      }
    }
    std::sort(pair_at.begin(), pair_at.end());
    around_.box.resize(crossings_.size());
    for (const Triangle& face : whole_.mesh.faces) {
      for (const Index v : face) {
        const auto first = std::lower_bound(pair_at.begin(), pair_at.end(), std::pair(v, Index{0}));
        for (auto it = first; it != pair_at.end() && it->first == v; ++it) {
          for (const Index w : face) around_.box[it->second].add(whole_.mesh.vertices[w]);
        }
      }
    }
  }

  void add(Index f, std::vector<Index>& number) {
    Triangle face = whole_.mesh.faces[f];
    for (Index& v : face) {
      if (number[v] == kNone) {
        number[v] = static_cast<Index>(around_.vertex.size());
        around_.vertex.push_back(v);
        around_.surface.mesh.vertices.push_back(whole_.mesh.vertices[v]);
        around_.surface.binding.push_back(whole_.binding[v]);
        around_.surface.radius.push_back(whole_.radius[v]);
      }
      v = number[v];
    }
    around_.face.push_back(f);
    around_.surface.mesh.faces.push_back(face);
  }

  const GatheredSurface& whole_;
  const std::vector<FacePair>& crossings_;
  Neighbourhood around_;
};

class Parting {
 public:
  Parting(Neighbourhood& around, const VesselField& field)
      : surface_(around.surface), field_(field), patch_(surface_, field) {}

  // Takes the best step at a face that crosses another, if any helps.
  bool part(Index f, const Box& box) {
    std::vector<Patch::Step> steps;
    const Triangle face = surface_.mesh.faces[f];
    for (std::size_t k = 0; k < 3; ++k) {
      add_steps(MeshEdge{face[k], face[(k + 1) % 3]}, steps);
      add_move(face[k], steps);
    }
    std::erase_if(steps, [&](const Patch::Step& step) { return !is_offered(step, box); });
    return patch_.take_best(steps, kWorstLeft) != kNone;
  }

 private:
  void add_steps(const MeshEdge& e, std::vector<Patch::Step>& steps) const {
    if (!patch_.is_inner(e)) return;
    if (patch_.may_flip(e)) steps.push_back(patch_.flipping(e));
    const std::vector<Vec3>& points = surface_.mesh.vertices;
    for (const double slide : kSlides) {
      const Vec3 p = (0.5 - slide) * points[e.a] + (0.5 + slide) * points[e.b];
      steps.push_back(patch_.splitting(e, on_boundary(p, e.a)));
    }
  }

  void add_move(Index v, std::vector<Patch::Step>& steps) const {
    if (patch_.is_inner(v)) steps.push_back(patch_.moving(v, on_boundary(surface_.mesh.vertices[v], v)));
  }

  BoundaryPoint on_boundary(const Vec3& p, Index at) const {
    return project_to_boundary(field_, p, surface_.binding[at].segment);
  }

  bool is_offered(const Patch::Step& step, const Box& box) const {
    if (step.vertex != kNone && !box.holds(step.at.position)) return false;
    return std::all_of(step.faces.begin(), step.faces.end(), [&](const Triangle& f) { return is_upright(f, step); });
  }

  bool is_upright(const Triangle& f, const Patch::Step& step) const {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = f[k] == step.vertex ? step.at.position : surface_.mesh.vertices[f[k]];
    const Index hint = f[0] == step.vertex ? step.at.sample.cone : surface_.binding[f[0]].segment;
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
    const Vec3 outwards = field_.sample((p[0] + p[1] + p[2]) / 3, hint).gradient;
    return normal.dot(outwards) >= kUpright * normal.norm() * outwards.norm();
  }

  FinishedSurface& surface_;
  const VesselField& field_;
  Patch patch_;
};

void put_back(const Neighbourhood& around, GatheredSurface& whole) {
  const FinishedSurface& surface = around.surface;
  std::vector<Index> number = around.vertex;
  for (Index v = 0; v < surface.mesh.vertices.size(); ++v) {
    if (v == number.size()) {
      number.push_back(static_cast<Index>(whole.mesh.vertices.size()));
      whole.mesh.vertices.emplace_back();
      whole.binding.emplace_back();
      whole.radius.emplace_back();
    }
    whole.mesh.vertices[number[v]] = surface.mesh.vertices[v];
    whole.binding[number[v]] = surface.binding[v];
    whole.radius[number[v]] = surface.radius[v];
  }
  for (Index f = 0; f < surface.mesh.faces.size(); ++f) {
    const auto [a, b, c] = surface.mesh.faces[f];
    const Triangle face = {number[a], number[b], number[c]};
    if (f < around.face.size()) {
      whole.mesh.faces[around.face[f]] = face;
    } else {
      whole.mesh.faces.push_back(face);
    }
  }
}

}  // namespace

std::vector<FacePair> part_walls(GatheredSurface& surface, const VesselField& field,
                                 const std::vector<FacePair>& crossings) {
  if (crossings.empty()) return {};
  Neighbourhood around = NeighbourhoodMaker(surface, crossings).run();
  const auto local = [&](Index f) {
    return static_cast<Index>(std::lower_bound(around.face.begin(), around.face.end(), f) - around.face.begin());
  };
  Parting parting(around, field);
  std::vector<FacePair> left;
  for (Index i = 0; i < crossings.size(); ++i) {
    const Index f = local(crossings[i].first), g = local(crossings[i].second);
    const TriMesh& mesh = around.surface.mesh;
    if (!intersect(placed(mesh, f), placed(mesh, g))) continue;
    if (!parting.part(f, around.box[i]) && !parting.part(g, around.box[i])) left.push_back(crossings[i]);
  }
  // A step at a later pair may also have parted an earlier one.
  std::erase_if(left, [&](const FacePair& pair) {
    return !intersect(placed(around.surface.mesh, local(pair.first)), placed(around.surface.mesh, local(pair.second)));
  });
  put_back(around, surface);
  return left;
}

}  // namespace vmesh

#include "surface/pieces/parting.h"

#include <algorithm>

#include "vmesh/core/box_tree.h"
#include "vmesh/edit/guarded_edit.h"

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

// The neighbourhood of crossing faces as a surface of its own, with its numbers in the whole surface.
struct Neighbourhood {
  FinishedMesh mesh;
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
    around_.mesh = FinishedMesh(std::move(faces_), std::move(vertices_));
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
        vertices_.push_back({whole_.mesh.vertices[v], whole_.binding[v], whole_.radius[v]});
      }
      v = number[v];
    }
    around_.face.push_back(f);
    faces_.push_back(face);
  }

  const GatheredSurface& whole_;
  const std::vector<FacePair>& crossings_;
  Neighbourhood around_;
  std::vector<Triangle> faces_;
  std::vector<FinishedVertex> vertices_;
};

class Parting {
 public:
  Parting(FinishedMesh& mesh, const VesselField& field) : mesh_(mesh), field_(field), edit_(mesh) {}

  // Takes the best step at a face that crosses another, if any helps.
  bool part(Index f, const Box& box) {
    std::vector<Step> steps;
    const Triangle face = mesh_.faces()[f];
    for (std::size_t k = 0; k < 3; ++k) {
      add_steps(MeshEdge{face[k], face[(k + 1) % 3]}, steps);
      add_move(face[k], steps);
    }
    std::erase_if(steps, [&](const Step& step) { return !is_offered(step, box); });
    return edit_.take_best(steps, kWorstLeft) != kNone;
  }

 private:
  using Step = FinishedMesh::Step;

  void add_steps(const MeshEdge& e, std::vector<Step>& steps) const {
    if (!mesh_.is_inner(e)) return;
    if (mesh_.may_flip(e)) steps.push_back(mesh_.flipping(e));
    for (const double slide : kSlides) {
      const Vec3 p = (0.5 - slide) * mesh_.position(e.a) + (0.5 + slide) * mesh_.position(e.b);
      steps.push_back(mesh_.splitting(e, on_boundary(p, e.a)));
    }
  }

  void add_move(Index v, std::vector<Step>& steps) const {
    if (mesh_.is_inner(v)) steps.push_back(mesh_.moving(v, on_boundary(mesh_.position(v), v)));
  }

  FinishedVertex on_boundary(const Vec3& p, Index at) const {
    return finished_vertex(project_to_boundary(field_, p, mesh_.vertex(at).binding.segment), field_);
  }

  bool is_offered(const Step& step, const Box& box) const {
    if (step.vertex != kNone && !box.holds(step.target.position)) return false;
    return std::all_of(step.faces.begin(), step.faces.end(), [&](const Triangle& f) { return is_upright(f, step); });
  }

  bool is_upright(const Triangle& f, const Step& step) const {
    const std::array<Vec3, 3> p = mesh_.placed(f, step).points;
    const FinishedVertex& first = f[0] == step.vertex ? step.target : mesh_.vertex(f[0]);
    const Index hint = first.binding.segment;
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
    const Vec3 outwards = field_.sample((p[0] + p[1] + p[2]) / 3, hint).gradient;
    return normal.dot(outwards) >= kUpright * normal.norm() * outwards.norm();
  }

  FinishedMesh& mesh_;
  const VesselField& field_;
  GuardedEdit<FinishedVertex> edit_;
};

BeforeParting remembered(const Neighbourhood& around, const GatheredSurface& whole) {
  BeforeParting before{around.vertex, around.face, {}, {}, whole.mesh.vertices.size(), whole.mesh.faces.size()};
  for (const Index v : around.vertex)
    before.old_vertex.push_back({whole.mesh.vertices[v], whole.binding[v], whole.radius[v]});
  for (const Index f : around.face) before.old_face.push_back(whole.mesh.faces[f]);
  return before;
}

void put_back(const Neighbourhood& around, GatheredSurface& whole) {
  std::vector<Index> number = around.vertex;
  for (Index v = 0; v < around.mesh.vertices().size(); ++v) {
    if (v == number.size()) {
      number.push_back(static_cast<Index>(whole.mesh.vertices.size()));
      whole.mesh.vertices.emplace_back();
      whole.binding.emplace_back();
      whole.radius.emplace_back();
    }
    const FinishedVertex& vertex = around.mesh.vertex(v);
    whole.mesh.vertices[number[v]] = vertex.position;
    whole.binding[number[v]] = vertex.binding;
    whole.radius[number[v]] = vertex.radius;
  }
  for (Index f = 0; f < around.mesh.faces().size(); ++f) {
    const auto [a, b, c] = around.mesh.faces()[f];
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
                                 const std::vector<FacePair>& crossings, BeforeParting* before) {
  if (crossings.empty()) return {};
  Neighbourhood around = NeighbourhoodMaker(surface, crossings).run();
  const auto local = [&](Index f) {
    return static_cast<Index>(std::lower_bound(around.face.begin(), around.face.end(), f) - around.face.begin());
  };
  Parting parting(around.mesh, field);
  const auto cross = [&](const FacePair& pair) {
    return intersect(around.mesh.placed(local(pair.first)), around.mesh.placed(local(pair.second)));
  };
  std::vector<FacePair> left;
  for (Index i = 0; i < crossings.size(); ++i) {
    const Index f = local(crossings[i].first), g = local(crossings[i].second);
    if (!cross(crossings[i])) continue;
    if (!parting.part(f, around.box[i]) && !parting.part(g, around.box[i])) left.push_back(crossings[i]);
  }
  // A step at a later pair may also have parted an earlier one.
  std::erase_if(left, [&](const FacePair& pair) { return !cross(pair); });
  if (before != nullptr) *before = remembered(around, surface);
  put_back(around, surface);
  return left;
}

void take_back(const BeforeParting& before, GatheredSurface& surface) {
  if (before.face.empty()) return;
  surface.mesh.vertices.resize(before.vertices);
  surface.binding.resize(before.vertices);
  surface.radius.resize(before.vertices);
  surface.mesh.faces.resize(before.faces);
  for (std::size_t i = 0; i < before.vertex.size(); ++i) {
    const auto& [position, binding, radius] = before.old_vertex[i];
    surface.mesh.vertices[before.vertex[i]] = position;
    surface.binding[before.vertex[i]] = binding;
    surface.radius[before.vertex[i]] = radius;
  }
  for (std::size_t i = 0; i < before.face.size(); ++i) surface.mesh.faces[before.face[i]] = before.old_face[i];
}

}  // namespace vmesh

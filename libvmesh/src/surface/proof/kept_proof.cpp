#include "surface/proof/kept_proof.h"

#include <algorithm>

#include <tbb/parallel_for.h>

namespace vmesh {
namespace {

// Around faces that are not proven: shells may be bent for them there. One: a hepatic vein's 39 become 41.
constexpr int kFixedRings = 2;

using Corner = ErrorProof::Corner;
using Shares = ErrorProof::Shares;

bool is_proven(const Shares& shares) { return shares.inner > 0 && shares.outer > 0; }

bool is_gone(const SurfaceStep& step, Face f) {
  return std::find(step.gone.begin(), step.gone.end(), f) != step.gone.end();
}

template <class Key, class Value>
const Value* find(const std::vector<std::pair<Key, Value>>& all, Key key) {
  const auto it = std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.first == key; });
  return it == all.end() ? nullptr : &it->second;
}

// The vertex as it will be after the step, or as it is if that changes nothing.
const Corner& corner_in(const KeptProof::Outlook& outlook, const std::vector<Corner>& now, Vertex v) {
  const Corner* changed = find(outlook.corners, v);
  return changed ? *changed : now[v.idx()];
}

ErrorProof::Face face_in(const KeptProof::Outlook& outlook, const std::vector<Corner>& now, const FaceCorners& f) {
  return {corner_in(outlook, now, f[0]), corner_in(outlook, now, f[1]), corner_in(outlook, now, f[2])};
}

}  // namespace

KeptProof::KeptProof(const SweepState& state, const ErrorLimit& limit)
    : state_(state), surface_(state.surface), mesh_(state.mesh), limit_(limit), proof_(state.field) {
  corner_.resize(mesh_.num_vertices());
  for (const Vertex v : mesh_.vertices()) corner_[v.idx()] = corner_of(v);
  shares_.resize(mesh_.num_faces());
  fixed_.assign(mesh_.num_faces(), 0);
  std::vector<Face> faces;
  std::vector<Triangle> triangles;
  for (const Face f : mesh_.faces()) {
    if (surface_.is_lid(f)) continue;
    const auto [a, b, c] = state_.corners(f);
    faces.push_back(f);
    triangles.push_back({a.idx(), b.idx(), c.idx()});
  }
  std::vector<Shares> shares(faces.size());
  tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) {
    shares[i] = proof_.shares({corner_[triangles[i][0]], corner_[triangles[i][1]], corner_[triangles[i][2]]});
  });
  for (std::size_t i = 0; i < faces.size(); ++i) shares_[faces[i].idx()] = shares[i];
  for (const Index i : proof_.unproven(corner_, triangles, shares)) fixed_[faces[i].idx()] = 1;
  for (int ring = 0; ring < kFixedRings; ++ring) fix_neighbours();
  for (const Face f : mesh_.faces()) {
    for (const Vertex v : state_.corners(f)) fixed_[f.idx()] |= surface_.held(v);
  }
}

void KeptProof::fix_neighbours() {
  std::vector<char> at_fixed(mesh_.num_vertices(), 0);
  for (const Face f : mesh_.faces()) {
    if (!is_fixed(f)) continue;
    for (const Vertex v : state_.corners(f)) at_fixed[v.idx()] = 1;
  }
  for (const Face f : mesh_.faces()) {
    for (const Vertex v : state_.corners(f)) fixed_[f.idx()] |= at_fixed[v.idx()];
  }
}

Corner KeptProof::corner_of(Vertex v) const {
  return {state_.point(v), surface_.middle_normal(v), limit_.at(surface_.radius(v)), surface_[v].cone};
}

std::optional<KeptProof::Outlook> KeptProof::after(const SurfaceStep& step) const {
  Outlook outlook;
  for (const FaceCorners& f : step.faces) {
    for (const Vertex v : f) {
      if (!find(outlook.corners, v)) outlook.corners.emplace_back(v, corner_after(step, v));
    }
  }
  // Shells get no lower than they are.
  Shares least{1, 1};
  for (const Face f : step.gone) {
    least.inner = std::min(least.inner, shares_[f.idx()].inner);
    least.outer = std::min(least.outer, shares_[f.idx()].outer);
  }
  for (const FaceCorners& f : step.faces) {
    outlook.made.emplace_back(f, proof_.shares(face_in(outlook, corner_, f), least));
    if (!is_proven(outlook.made.back().second)) return std::nullopt;
  }
  for (const auto& [v, changed] : outlook.corners) {
    for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) {
      if (is_gone(step, f) || find(outlook.kept, f)) continue;
      if (is_fixed(f)) return std::nullopt;
      outlook.kept.emplace_back(f, proof_.shares(face_in(outlook, corner_, state_.corners(f)), shares_[f.idx()]));
      if (!is_proven(outlook.kept.back().second)) return std::nullopt;
    }
  }
  return outlook;
}

Corner KeptProof::corner_after(const SurfaceStep& step, Vertex v) const {
  const auto position = [&](Vertex x) -> const Vec3& {
    return x == step.vertex ? step.target.position : state_.point(x);
  };
  Vec3 normal = Vec3::Zero();
  const auto add = [&](const FaceCorners& f) {
    const auto k = static_cast<std::size_t>(std::find(f.begin(), f.end(), v) - f.begin());
    if (k < 3) normal += angle_normal(position(v), position(f[(k + 1) % 3]), position(f[(k + 2) % 3]));
  };
  for (const FaceCorners& f : step.faces) add(f);
  for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) {
    if (!is_gone(step, f)) add(state_.corners(f));
  }
  normal.normalize();
  if (v != step.vertex) return {state_.point(v), normal, corner_[v.idx()].limit, corner_[v.idx()].cone};
  const FieldSample& s = step.target.sample;
  return {step.target.position, normal, limit_.at(state_.field.relations().radius_at(s.cone, s.t)), s.cone};
}

bool KeptProof::Surroundings::are_even() const {
  return std::all_of(faces.begin(), faces.end(),
                     [](const auto& f) { return f.second.inner == 1 && f.second.outer == 1; });
}

std::vector<Vertex> KeptProof::Surroundings::vertices() const {
  std::vector<Vertex> all;
  for (const auto& [f, shares] : faces) all.insert(all.end(), f.begin(), f.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void KeptProof::add_around(Vertex v, const SurfaceStep& step, const Outlook& outlook, Surroundings& to) const {
  for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) {
    if (is_gone(step, f) || std::find(to.known.begin(), to.known.end(), f) != to.known.end()) continue;
    const Shares* changed = find(outlook.kept, f);
    to.known.push_back(f);
    to.faces.emplace_back(state_.corners(f), changed ? *changed : shares_[f.idx()]);
    to.at_fixed = to.at_fixed || is_fixed(f);
  }
}

// Where faces need shells of different heights at a corner, the lowest counts (ErrorProof::unproven). Whether all faces
// whose heights the step may change hold with them.
bool KeptProof::holds(const SurfaceStep& step, const Outlook& outlook) const {
  Surroundings changed{outlook.made, {}};
  for (const auto& [f, shares] : outlook.kept) changed.faces.emplace_back(state_.corners(f), shares);
  Surroundings near{outlook.made, {}};
  for (const Vertex v : changed.vertices()) add_around(v, step, outlook, near);
  if (near.are_even()) return true;
  if (near.at_fixed) return false;  // heights of faces that are not proven must not change
  Surroundings wider = near;
  for (const Vertex v : near.vertices()) add_around(v, step, outlook, wider);
  const auto face_holds = [&](const std::pair<FaceCorners, Shares>& face, ErrorProof::Side side) {
    const auto share = [&](const Shares& s) { return side == ErrorProof::Side::inner ? s.inner : s.outer; };
    const ErrorProof::Face corners = face_in(outlook, corner_, face.first);
    std::array<double, 3> own, heights;
    for (std::size_t k = 0; k < 3; ++k) {
      own[k] = share(face.second) * corners[k].limit;
      heights[k] = corners[k].limit;
      for (const auto& [f, shares] : wider.faces) {
        if (share(shares) > 0 && has(f, face.first[k]))
          heights[k] = std::min(heights[k], share(shares) * corners[k].limit);
      }
    }
    return heights == own || proof_.holds(corners, heights, side);
  };
  return std::all_of(near.faces.begin(), near.faces.end(), [&](const auto& face) {
    return face_holds(face, ErrorProof::Side::inner) && face_holds(face, ErrorProof::Side::outer);
  });
}

void KeptProof::note(const SurfaceStep& step, const Outlook& outlook, Vertex at) {
  for (const auto& [x, corner] : outlook.corners) corner_[(x == step.vertex ? at : x).idx()] = corner;
  for (const auto& [f, shares] : outlook.kept) shares_[f.idx()] = shares;
  for (const Face f : mesh_.faces_around_target(mesh_.halfedge(at))) {
    const FaceCorners corners = state_.corners(f);
    for (const auto& [made, shares] : outlook.made) {
      const bool same =
          std::all_of(made.begin(), made.end(), [&](Vertex x) { return has(corners, x == step.vertex ? at : x); });
      if (same) shares_[f.idx()] = shares;
    }
  }
}

}  // namespace vmesh

#pragma once

#include <vector>

#include "vmesh/edit/edit_mesh.h"
#include "vmesh/surface/generate.h"

#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// A surface when it has grown.
struct FinishedSurface {
  TriMesh mesh;
  std::vector<CenterlineBinding> binding;  ///< of every vertex
  std::vector<double> radius;              ///< of the vessel there, mm
  std::vector<Opening> openings;           ///< node, centre, radius and ring
  std::vector<Index> held;                 ///< other vertices that stay, and faces there
};

struct FinishedVertex {
  Vec3 position = Vec3::Zero();
  CenterlineBinding binding;
  double radius = 0;
};

using FinishedMesh = EditMesh<FinishedVertex>;

inline FinishedVertex finished_vertex(const BoundaryPoint& at, const VesselField& field) {
  const FieldSample& sample = at.sample;
  return {at.position, {sample.cone, sample.t}, field.relations().radius_at(sample.cone, sample.t)};
}

/// All ways to merge a vertex with one beside it, which stays where it is.
std::vector<FinishedMesh::Step> merges(const FinishedMesh& mesh, Index v);

/// To change a finished surface.
FinishedMesh finished_mesh(const FinishedSurface& surface);

/// Puts the changed surface back, without what has been removed. Returns the new number of every vertex.
std::vector<Index> put_back(FinishedMesh mesh, FinishedSurface& surface);

}  // namespace vmesh

#pragma once

#include <cstddef>

#include "vmesh/volume/cone_relations.h"

#include "fit/fit_mesh.h"

namespace vmesh::fitting {

/// Sets the elongation of the vertices of a packed surface: the direction of least curvature, times the ratio by which
/// triangles of least error are longer along it than across. That is the root of the ratio of the curvatures (Heckbert,
/// Garland, "Optimal triangulation and quadric-based surface simplification", 1999); `most` at most. Curvatures are
/// averaged over a few edges.
void find_elongation(FitMesh& surface, double most);

/// Leaves out vertices of a packed surface until `vertices` are left or no more can go: collapses edges where that
/// sweeps the least volume, each to the point that keeps the enclosed volume and sweeps the least (Lindstrom, Turk,
/// "Fast and memory efficient polygonal simplification", 1998). No faces cross. None becomes skewer than `max_skewness`
/// in the metric of the vertices' elongation, unless another there was. Vertices on openings stay. With `joints`, no
/// edge becomes longer along the vessel than its segments are, unless it is no longer than FitVertex::base_size.
void coarsen(FitMesh& surface, std::size_t vertices, double max_skewness, const ConeRelations* joints = nullptr);

}  // namespace vmesh::fitting

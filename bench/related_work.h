#pragma once

#include "vmesh/centerline/centerline.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::bench {

/// The surfaces that the paper's section on related work names, made as published, to compare with.

/// A cylinder of `sides` around every segment, as wide as the mean of its ends, closed and not joined to others: "a
/// simple approach", which leads "to surface intersections at the branches".
TriMesh plain_cylinders(const Centerline& centerline, int sides);

/// The convolution surface of the segments, by marching cubes on voxels of `step` mm.
///
/// J. Bloomenthal, K. Shoemake, *Convolution surfaces*, SIGGRAPH 1991: a Gaussian convolved with a segment is the
/// product of a filter of the distance from its line and an integral along it. S. Oeltze, B. Preim, *Visualization of
/// vasculature with convolution surfaces: method, validation and evaluation*, IEEE Transactions on Medical Imaging 24
/// (2005): distances count in radii at the foot point, so that the surface has the radius of a straight vessel. With
/// the distance d from the line, the radius r at the foot and the way x along the segment of length l,
///   F = sum over segments of exp(-width d^2 / r^2) (erf(a x) - erf(a (x - l))) / 2,  a = sqrt(width) / r,
/// is contoured at exp(-width), its value on a long straight vessel. `width`: ln 2 is the Gaussian of the first paper,
/// which bulges where vessels meet and swallows thin ones beside thick ones; larger ones do less of both.
TriMesh convolution_surface(const Centerline& centerline, double width, double step);

struct MpuOptions {
  double voxel = 0;      ///< side of those of the mask, mm
  double tolerance = 0;  ///< largest distance of the mask's points from a local fit, mm
  double step = 0;       ///< of marching cubes, mm
};

/// Multi-level partition of unity implicits of the boundary of the centerline's mask, by marching cubes.
///
/// Y. Ohtake, A. Belyaev, M. Alexa, G. Turk, H.-P. Seidel, *Multi-level partition of unity implicits*, ACM Transactions
/// on Graphics 22 (2003): an octree whose cells are halved until a quadric fits the points in a ball around them; the
/// fits are blended by quadratic B-splines. Without their fits for edges and corners, which vessels have not. For
/// vessels: C. Schumann, S. Oeltze, R. Bade, B. Preim, H.-O. Peitgen, *Model-free surface visualization of vascular
/// trees*, EuroVis 2007, where points come from the voxels at the boundary of a segmentation; here from the middles
/// between neighbours inside and outside, with normals from the mask around. Far from all points, where fits say
/// nothing, the mask decides.
TriMesh mpu_surface(const Centerline& centerline, const MpuOptions& options);

}  // namespace vmesh::bench

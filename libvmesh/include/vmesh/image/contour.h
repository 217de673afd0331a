#pragma once

#include "vmesh/image/voxel_image.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// The surface around all values of at least `isovalue` by marching cubes, in LPS and mm. Closed, manifold and oriented
/// outwards; everything beyond the image's border counts as outside. Vertices lie on edges between voxels, interpolated
/// linearly, in the order of rows of voxels; after them come few within cells. The topology is that of the trilinear
/// interpolant within every cell (on faces the asymptotic decider, within cells tubes where the interpolant has them);
/// that of a mask, at a level half between its values, is that of its voxels, connected inside by faces and outside by
/// corners. Values close to `isovalue` are moved off it, so that no vertex comes closer to a voxel's centre than about
/// a thousandth of a voxel and no vertices coincide. The same bytes with any number of threads. Surfaces of tubes may
/// cross themselves within a cell, which about one in a hundred of one kind (a corner and an edge across) does. Throws
/// InvalidInput if no value is inside.
///
/// W. E. Lorensen, H. E. Cline, *Marching cubes: a high resolution 3D surface construction algorithm*, SIGGRAPH 1987;
/// G. M. Nielson, B. Hamann, *The asymptotic decider*, Visualization 1991; E. V. Chernyaev, *Marching Cubes 33*, CERN
/// CN/95-17, 1995.
TriMesh contour(const VoxelImage& image, double isovalue);

/// Memory that contour() needs per voxel besides the image itself (bytes): a bit, and 60 bytes per vertex (measured)
/// for one in 16 voxels; around vessels there are fewer.
inline constexpr double kContourBytesPerVoxel = 4;

}  // namespace vmesh

// The inside of a closed wall as voxels, internal to the module.
#pragma once

#include "vmesh/mesh/tri_mesh.h"

#include "voxel_skeleton.h"

namespace vmesh::skeleton {

struct VoxelVolume {
  VoxelSet voxels;
  VoxelFrame frame;
};

/// A third of the radius of the thinnest vessels, as far as a few million voxels allow. `volume`: mm^3, positive.
double voxel_size_for(const TriMesh& wall, double volume);

/// Voxels whose centres are inside a closed, oriented, outward-facing wall: that it winds around, so faces that cross
/// do no harm.
VoxelVolume voxels_inside(const TriMesh& wall, double voxel);

}  // namespace vmesh::skeleton

// What a VesselMask holds, internal to the module.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "cone_fit.h"
#include "voxel_skeleton.h"

namespace vmesh::skeleton {

/// Where a grey value passes the threshold between two neighbouring voxels.
struct Crossing {
  Voxel inside;
  signed char axis = 0, way = 0;  ///< to the voxel outside: way is 1 or -1
  float share = 0;                ///< of the step
};

struct MaskContent {
  VoxelSet voxels;    ///< without holes once these are filled
  VoxelSet as_given;  ///< with small holes: the wall is measured on what is given, so that noise on either side cancels
  VoxelFrame frame;
  ReferenceOptions options;
  std::vector<Crossing> crossings;  ///< of grey values
  std::vector<float> last_slice;    ///< of grey values
  std::set<float> values;           ///< besides 0, the first few
  float highest = 0;
};

/// A vessel cut by the image's border.
struct BorderEnd {
  KnownEnd end;
  Voxel middle{};
  int axis = 0, way = 0;  ///< of the border
  double area = 0;        ///< mm^2
};
std::vector<BorderEnd> border_ends(const VoxelSet& voxels, const VoxelFrame& frame);

/// The wall between the voxels and their neighbours outside; `component_of_sample` is that of the voxel. Where the
/// border cuts a vessel, there is no wall.
FitSamples wall_of(const MaskContent& mask, const std::vector<BorderEnd>& ends, const std::vector<Index>& component,
                   std::vector<Index>& component_of_sample);

/// The voxels inside that have a neighbour outside, and those neighbours, unless they are beyond the image.
FitVoxels voxels_beside_wall(const MaskContent& mask, const std::vector<Index>& component,
                             std::vector<Index>& component_of_voxel);

}  // namespace vmesh::skeleton

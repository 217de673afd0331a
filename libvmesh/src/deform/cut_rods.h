// Rods that go on moving after a cut.
#pragma once

#include <vector>

#include "vmesh/centerline/cut.h"

#include "deform/rod_scene.h"
#include "deform/slot_origin.h"

namespace vmesh {

/// A cut whose two ends are one node, so that nothing parts.
CenterlineCut uncut(const InsertedNode& node);

/// Throws InvalidInput for a cut of another centerline, and for a node that is held or loaded, as its load would belong
/// to one part only.
void require_cut(const RodScene& scene, const CenterlineCut& cut);

/// The segment cut has the same springs per length, and its mass is divided.
std::vector<SegmentProperties> cut_properties(std::vector<SegmentProperties> properties, const CenterlineCut& cut);

/// By slot of the tree after the cut.
std::vector<SlotOrigin> slot_origins(const RodTree& before, const RodTree& after, const CenterlineCut& cut);

/// The scene after the cut, in the same state. What hung from the segment cut is a tree of its own with the same slots
/// below the cut, unless a loop joins it to the other part. Springs between two segments stay as they are, also where
/// one of them is shorter now, so that a cut adds no energy.
RodScene cut_scene(const RodScene& before, const CenterlineCut& cut, const std::vector<SegmentProperties>& properties);

}  // namespace vmesh

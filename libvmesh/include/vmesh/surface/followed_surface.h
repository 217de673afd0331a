#pragma once

#include <vector>

#include "vmesh/centerline/edits.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// Where the vertices of a surface around `centerline` go when that is edited: each keeps its place on the centerline,
/// and the vector from there to it is scaled as the radius is. Connectivity stays, so whether faces turn over or cross
/// is for the caller to check. Throws InvalidInput if the edit removes branches, for a binding that does not fit, and
/// as edit_centerline() does.
std::vector<Vec3> follow_edit(const std::vector<Vec3>& vertices, const std::vector<CenterlineBinding>& binding,
                              const Centerline& centerline, const CenterlineEdit& edit);

/// Where points within the vessels, or near them, go: likewise, from the nearest place of their branch. Where branches
/// meet, from all of them, the nearer the more, so that what is between two branches is stretched and not torn. Throws
/// InvalidInput if the edit removes branches or the centerline is empty, and as edit_centerline() does.
std::vector<Vec3> follow_edit_within(const std::vector<Vec3>& points, const Centerline& centerline,
                                     const CenterlineEdit& edit);

/// By which lengths across the vessels change at these points then, `scale` included. Throws as follow_edit_within().
std::vector<double> widening_within(const std::vector<Vec3>& points, const Centerline& centerline,
                                    const CenterlineEdit& edit);

}  // namespace vmesh

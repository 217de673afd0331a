#pragma once

#include <vector>

#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/proof/finished_surface.h"

namespace vmesh {

/// Closes the gap between two walls where it ends in a notch and the limit is not proven.
///
/// Where walls meet at an angle w, their gap is 2 d tan(w / 2) wide at the distance d from its end. An edge across it
/// there has the end d below it, which is within the limit only if the edge is shorter than 2 limit tan(w / 2): edges
/// would have to shrink with w. Instead a vertex is placed in the middle of the gap at the height h = a quarter of the
/// limit above its end, a little more where that leaves bad triangles. The gap below is closed: the vertex is at most h
/// sin(w / 2) from either wall, and the walls below are at most h from the vertex. Faces that end there lie along one
/// wall or the other and may be as long as elsewhere.
///
/// This motivates the steps; the proof for every remaining face is ErrorProof's: at the vertex, one copy of the surface
/// is shifted down by less than the limit, across the end of the gap and into both vessels; the other up the middle of
/// the gap by H, to (h + H) sin(w / 2) from either wall. The closed region lies between the two and is covered by the
/// proof.
///
/// The surface keeps its topology, and no faces cross that did not before. It is changed only if that leaves fewer
/// faces unproven. Returns what is known of the error.
ErrorSummary close_notches(FinishedSurface& surface, const VesselField& field, const ErrorLimit& limit);

/// Sorts them as summaries have them.
void deepest_first(std::vector<ClosedNotch>& notches);

}  // namespace vmesh

#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "vmesh/edit/guarded_edit.h"

#include "surface/proof/crease.h"
#include "surface/proof/finished_surface.h"

namespace vmesh {

/// Brings a surface that spans the gap between two walls down to the crease where they meet. A strip of faces from wall
/// to wall is replaced as a whole by two that meet in vertices on the crease, one along either wall: the first edges
/// that go down one by one leave faces across the gap that turn over with the next.
///
/// `faces`: where edges across gaps are looked for; `limit_at`: mm, of a vertex; `held`: vertices that keep their
/// faces. Returns the vertices on creases.
std::vector<std::pair<Index, Crease>> plough(FinishedMesh& mesh, GuardedEdit<FinishedVertex>& edit,
                                             const VesselField& field, const std::vector<Index>& faces,
                                             const std::function<double(Index)>& limit_at,
                                             const std::vector<char>& held);

}  // namespace vmesh

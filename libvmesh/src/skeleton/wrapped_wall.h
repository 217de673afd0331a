// Walls around surfaces that have no sides, internal to the module.
#pragma once

#include <string>
#include <vector>

#include "vmesh/core/progress.h"

#include "openings.h"

namespace vmesh::skeleton {

struct WrappedWall {
  std::vector<Shell> shells;  ///< closed, outward, in one piece each
  double offset = 0;          ///< mm by which the wrap lay outside before its vertices were moved back
  std::string note;
};

/// Wraps faces of any kind from outside (CGAL's alpha wrap), so finely that the vessels' mean radius is resolved but
/// not so finely that the wrap enters open vessels, and moves the wrap back onto the faces. `soup`: the faces, with
/// labels and ends like a shell's; faces of the wrap take the labels of the nearest. Throws Cancelled.
WrappedWall wrapped(const Shell& soup, const Progress& progress);

}  // namespace vmesh::skeleton

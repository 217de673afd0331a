#pragma once

#include <vector>

#include "vmesh/surface/generate.h"

namespace vmesh {

/// Where the wall next to an opening's ring rises to the ring's plane or over it, a flat cap would meet it at half a
/// turn or more, and nothing that follows the wall inwards could end on the cap. Moves such vertices back along the
/// vessel, as far as the wall needs to leave the plane, unless faces would then cross others. Fits alone leave such
/// walls.
void lower_overhangs(GenerateResult& result);

}  // namespace vmesh

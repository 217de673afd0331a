#include "surface/proof/refinement_way.h"

#include <iterator>

namespace vmesh {
namespace {

constexpr double kAny = -2;  // no cosine is less
// The second: where a thin vessel leaves a thick one, their rounding may be as narrow as edges are short.
const RefinementWay kWays[] = {{true, false, {0, 0}, 0},
                               {true, false, {0, 0}, 0, 0.1},
                               {false, false, {kAny, kAny}, 0.3},
                               {false, false, {0.3, 0}, 0},
                               {false, false, {0.15, 0.15}, 0.15},
                               {true, false, {kAny, kAny}, 0},
                               {false, true, {0, 0}, 0},
                               {false, false, {0, 0}, 0},
                               {true, false, {0, 0}, 0, 0.1, true},
                               {false, false, {kAny, kAny}, 0, 0.1, true}};

}  // namespace

int refinement_ways() { return static_cast<int>(std::size(kWays)); }

const RefinementWay& refinement_way(int number) { return kWays[number]; }

}  // namespace vmesh

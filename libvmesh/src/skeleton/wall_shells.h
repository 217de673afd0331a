// The connected pieces of a surface, internal to the module.
#pragma once

#include <string>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::skeleton {

/// The side of face f from corner i to the next is numbered 3 f + i. The side on the other side of each one's edge;
/// kNone at boundaries.
using Mates = std::vector<Index>;

/// Of a mesh whose edges have at most two faces.
Mates mates_of(const TriMesh& mesh);

struct WallShells {
  /// In one piece each, manifold (coincident vertices where a surface touches itself), neighbouring faces facing the
  /// same side; possibly open, possibly inside out. In the order of their first faces.
  std::vector<TriMesh> sound;
  /// In one piece each, with edges of three faces or more that cannot be told apart, or with a single side.
  std::vector<TriMesh> unsound;
  std::vector<std::string> notes;
};

/// Merges equal vertices, and nearly equal ones at boundaries if that closes them; leaves out faces without corners of
/// their own, duplicates, and fins (patches that hang on an edge of others); takes surfaces that touch along edges
/// apart; turns faces to their neighbours' side. Faces without area that hold neighbours together stay. Positions must
/// be finite and indices valid.
WallShells shells_of(const TriMesh& surface);

}  // namespace vmesh::skeleton

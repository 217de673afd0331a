#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "vmesh/centerline/cut.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// A surface cut through with the vessel in it, by the plane across the vessel, and closed by two flat caps that
/// coincide. Vertices and faces keep their numbers, new ones come last; a face that the plane cuts becomes one of its
/// parts. Vertices very near to the plane are moved along the surface into it, so that no sliver arises and the volume
/// stays what it was, to rounding.
struct CutSurface {
  /// Where a vertex comes from: between two vertices of before, or the same one twice.
  struct VertexOrigin {
    Index a = kNone, b = kNone;
    double share = 0;  ///< of b
  };
  struct Cap {
    std::vector<Index> ring;  ///< vertices around it, counter-clockwise seen from outside
    Index first_face = 0, face_count = 0;
    Index vertex = kNone;  ///< one of those within, or of the ring if there is none
  };

  TriMesh mesh;
  /// On CenterlineCut::centerline. Caps belong to its ends, so that they stay flat when it moves, and so do the few
  /// vertices that were bound beyond the plane.
  std::vector<CenterlineBinding> binding;
  std::vector<VertexOrigin> vertex_origin;
  std::vector<Index> face_origin;  ///< a face of before; kNone: of a cap
  std::array<Cap, 2> cap;          ///< at CenterlineCut::end
  double cap_area_mm2 = 0;         ///< of each
  std::vector<Index> moved;        ///< vertices of before that were moved into the plane
};

/// Throws InvalidInput, and tells how far along the vessel there is room, if the plane meets another vessel or the
/// surface's border before it has passed all around, or if the cut would not leave a sound surface. `binding`: of the
/// surface's vertices on `centerline`, of which `cut` is. `named`: how places are called in messages, if not by their
/// own numbers.
CutSurface cut_surface(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding, const Centerline& centerline,
                       const CenterlineCut& cut, const std::function<SegmentPlace(const SegmentPlace&)>& named = {});

/// The attributes of the surface after the cut. New vertices have values between those that they come from; caps have
/// the radius, "segment" and "parameter" of the cut, which is at `place` of the centerline to which the attributes
/// refer. Caps are patches with numbers of their own (ModelFaceID, CapID), of the names given. Of other values of
/// faces, caps have those beside them.
MeshAttributes attributes_of_cut(MeshAttributes attributes, const CutSurface& surface, const SegmentPlace& place,
                                 double radius, const std::array<std::string, 2>& cap_names);

}  // namespace vmesh

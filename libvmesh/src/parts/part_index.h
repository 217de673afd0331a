#pragma once

#include <limits>

#include "vmesh/core/progress.h"
#include "vmesh/parts/join.h"

namespace vmesh {

struct PieceBox {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const PieceBox& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  bool meets(const PieceBox& other) const {
    return (low.array() <= other.high.array()).all() && (high.array() >= other.low.array()).all();
  }
};

/// What is kept of all parts without their surfaces in memory: the numbers of their vertices and faces in the whole,
/// and the boxes of their pieces.
struct PartIndex {
  struct Entry {
    std::filesystem::path part, surface;
    Index first_vertex = 0, first_face = 0;  ///< in the whole; of its pieces, without its seams
    std::size_t first_piece = 0;
  };

  PartsManifest manifest;
  std::vector<Entry> parts;
  std::vector<PieceBox> boxes;                     ///< of all pieces
  std::vector<Index> first_face;                   ///< of all pieces in the whole, and the end
  std::size_t vertices = 0, faces = 0;             ///< in all
  std::vector<std::pair<Index, Index>> crossings;  ///< within parts; faces of the whole
  GrowthSummary growth;

  std::size_t part_of_piece(std::size_t piece) const;
  std::size_t piece_of_face(Index face) const;
  /// The number in the whole of a part's vertex.
  Index vertex(std::size_t part, const PartSurface& surface, Index v) const {
    const Index of_seams = surface.seam_vertex_count();
    return v < of_seams ? surface.seams[v / surface.around] * surface.around + v % surface.around
                        : parts[part].first_vertex + v - of_seams;
  }
};

/// Reads every part once and checks that they belong together.
PartIndex index_parts(const std::filesystem::path& folder, const Progress& progress);

/// The pairs of faces of different parts that cross each other, as numbers of the whole.
std::vector<std::pair<Index, Index>> crossings_between_parts(const PartIndex& index, const Progress& progress);

/// What parting walls changed in the whole.
struct PartedWalls {
  struct Vertex {
    Index number;
    Vec3 position;
    CenterlineBinding binding;  ///< to the centerline that was split
    double radius;
    SimplifiedCenterline::Place place;
    Index branch;
  };

  std::vector<Vertex> moved;                        ///< ascending
  std::vector<Vertex> added;                        ///< numbered after all vertices of the whole
  std::vector<std::pair<Index, Triangle>> changed;  ///< faces, ascending
  std::vector<Triangle> added_faces;
  std::vector<std::pair<Index, Index>> left;  ///< that still cross
};

PartedWalls part_crossing_walls(const PartIndex& index, const std::vector<std::pair<Index, Index>>& crossings);

}  // namespace vmesh

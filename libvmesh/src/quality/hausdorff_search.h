#pragma once

#include <optional>
#include <vector>

#include "vmesh/quality/hausdorff.h"

#include "quality/distance_bounds.h"
#include "quality/face_blocks.h"

namespace vmesh {

/// How a piece is cut in two: its corner `apex` on one side, the others on the other; the parameters at which the edges
/// to the next two corners are cut, 1 at a corner.
struct PieceCut {
  int apex = 0;
  double next = 1, after_next = 1;
};

/// The search for the point of a mesh that is farthest from another mesh.
class HausdorffSearch {
 public:
  struct Goal {
    double tolerance = 0;           ///< mm
    double start = -1;              ///< distances up to this are ignored; if negative, some point is always found
    bool stop_above_start = false;  ///< the first larger distance ends the search
  };

  /// Keeps references. `to` contains the faces of the other mesh.
  HausdorffSearch(const TriMesh& from, const TriangleTree& to, const Goal& goal, const Progress& progress);

  void run();

  /// Bounds of the search, without a margin for rounding. `lower` is the start if nothing larger was found.
  double lower() const { return lower_; }
  double upper() const { return std::max(upper_, lower_); }
  /// A point at the distance `lower`; nullopt if nothing larger than the start was found.
  const std::optional<MeasuredPoint>& farthest() const { return farthest_; }
  Index farthest_face() const { return farthest_face_; }

 private:
  struct Ranked {
    double rank;
    Index item;
  };

  struct OpenPiece {
    Piece piece;
    int cuts;  // number of cuts that led to it
  };

  bool done() const { return goal_.stop_above_start && farthest_; }
  double good_enough() const { return lower_ + goal_.tolerance; }
  bool settle(double bound);
  MeasuredPoint measure(const Vec3& p, Index near, Index face);
  const NearestFace& measure_vertex(Index v, Index face);
  Piece whole_face(Index face) const;
  void look_at_blocks();
  void look_at_faces(const FaceBlock& block, Index near);
  void divide(Index face);
  void push_parts(const Piece& piece, const PieceCut& cut, int cuts, Index face, std::vector<OpenPiece>& open);
  MeasuredPoint measure_between(const MeasuredPoint& a, const MeasuredPoint& b, double share, Index face);

  const TriMesh& from_;
  const TriangleTree& tree_;
  Goal goal_;
  const Progress& progress_;
  double done_fraction_ = 0;
  std::size_t measured_ = 0;
  FaceBlocks blocks_;
  std::vector<NearestFace> vertices_;
  std::vector<Ranked> unsettled_;  // faces by upper bound
  double lower_, upper_ = 0;
  std::optional<MeasuredPoint> farthest_;
  Index farthest_face_ = kNone;
  Index last_found_ = kNone;
};

}  // namespace vmesh

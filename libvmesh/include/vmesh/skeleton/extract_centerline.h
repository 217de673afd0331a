#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/centerline/end_section.h"
#include "vmesh/core/progress.h"
#include "vmesh/core/stage_time.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/skeleton/vessel_mask.h"

namespace vmesh {

struct ExtractOptions {
  /// Distance between nodes along a vessel, in local radii; 0.1 to 10.
  double spacing = 1;
  /// Ends are joined with other components that they point at over gaps of up to this times the smaller radius, or of
  /// three voxels if that is more; 0 or more. 0: none.
  double join = 1;
  /// Keep the longest component only.
  bool largest = false;
  /// Components whose vessels are together shorter than this (mm) are left out; 0: those no longer than wide.
  double least_length = 0;
  /// Open all loops, each at its neck.
  bool tree = false;
  /// A wall's vertices lie off the vessels' boundary, so that its faces lie on it in the mean, as in surfaces that
  /// vmesh grows (Placement::balanced). false: the vertices lie on it, as in marching cubes and scans. Matters for
  /// walls with few faces around a vessel: an octagon of the same vertices is 5 % thinner.
  bool balanced_wall = false;
};

/// How far a wall, or a region of it, is from the boundary of the vessel volume, over its area.
struct WallDistance {
  double area = 0;                              ///< mm^2
  double mean = 0, percentile_95 = 0, max = 0;  ///< mm
  Vec3 max_at = Vec3::Zero();                   ///< on the wall, mm
};

/// A region of the wall that no vessel reaches.
struct MissedWall {
  Vec3 place = Vec3::Zero();  ///< mm
  double area = 0;            ///< mm^2
  double distance = 0;        ///< largest, from the vessels, mm
  std::string reason;
};

/// A loop of the vessels.
struct VesselLoop {
  Vec3 neck = Vec3::Zero();  ///< its thinnest contact, mm
  double neck_radius = 0;    ///< mm
  double radius = 0;         ///< of the thinner of the vessels that meet there, mm
  double length = 0;         ///< around, mm
  bool opened = false;
};

/// A gap over which vessels were joined.
struct JoinedGap {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< mm
  double gap = 0;                               ///< between the vessels' ends, mm
};

/// What extraction did, and how well the result represents the wall.
struct ExtractionReport {
  std::size_t components = 0;  ///< of the segmentation
  std::size_t left_out = 0;    ///< of them
  std::size_t spurs = 0;       ///< short branches that were removed
  std::vector<JoinedGap> joined;
  std::vector<VesselLoop> loops;   ///< necks thinnest beside their vessels first
  std::vector<MissedWall> missed;  ///< largest first
  /// Share of the wall's area that is within half a radius, or one and a half voxels, of the vessels' boundary.
  double coverage = 0;
  /// Share of the length of all paths, components left out included, that the centerline has.
  double length_coverage = 0;
  WallDistance wall;  ///< without the components left out
  /// Of the regions of the wall nearest to each branch, in the order of find_branches().
  std::vector<WallDistance> branches;
  std::vector<std::string> notes;  ///< what was done to the wall, or to the voxels, a line each
  std::vector<StageTime> stages;   ///< voxels, skeleton, cones, coverage
};

struct ExtractedCenterline {
  Centerline centerline;  ///< in canonical order (see CleaningOptions)
  std::vector<EndSection> end_sections;
  ExtractionReport report;
};

/// The centerline of a wall: a surface, open, closed or in pieces. Openings are closed, what has no sides is wrapped
/// (see the report's notes), and the inside is turned into voxels of a third of the thinnest vessels' radius. Geodesic
/// paths through the middle of the voxels give a graph with a vessel to every tip and around every loop; then positions
/// and radii are fitted so that the boundary of the union of round cones follows the wall itself, ends included. At
/// openings and flat caps the centerline ends in the middle, with an EndSection. Deterministic, whatever the threads.
/// Throws InvalidInput for a surface without faces, area or volume, and for options out of range; Unsupported if there
/// is not enough free memory; Cancelled.
ExtractedCenterline extract_centerline(const TriMesh& wall, const ExtractOptions& options = {},
                                       const Progress& progress = {});

/// The same of voxels, which are used up. Where the image's border cuts a vessel, there is an EndSection.
ExtractedCenterline extract_centerline(VesselMask mask, const ExtractOptions& options = {},
                                       const Progress& progress = {});

}  // namespace vmesh

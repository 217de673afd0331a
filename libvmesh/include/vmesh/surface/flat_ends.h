#pragma once

#include <string>
#include <vector>

#include "vmesh/surface/generate.h"
#include "vmesh/surface/section_ends.h"

namespace vmesh {

/// The longest extension that is made of its own accord, see FlatEndOptions::fit_extensions: five diameters.
inline constexpr double kLongestFittedExtension = 10;

/// How to finish the ends at which a surface was left open.
struct FlatEndOptions {
  /// Scale the rings to the area of the vessel's round cross-section, in which they are inscribed: with six vertices
  /// around, that cuts off a sixth; those at `sections`, to the area of these. A ring whose faces would then cross
  /// others stays as it is.
  bool keep_area = true;
  bool fitted = false;           ///< leave the rings that are not at sections where a fit has placed them
  bool cap = true;               ///< close the ends by flat caps
  std::vector<Index> left_open;  ///< nodes of the centerline whose ends stay open even so
  /// Length of a straight extension of the same cross-section that is first added at every end, in radii of the circle
  /// of equal area. 0: none.
  double extension = 0;
  /// Make each extension only as long as there is room for it, in the order of the nodes: a quarter of its radius is
  /// left free ahead, a twentieth beside. Where less than half of a radius would be left, there is none.
  bool fit_extensions = false;
  /// Ends at these nodes get these cross-sections, see end_at_sections(). The others, and those that cannot be kept,
  /// are cut across the vessel.
  std::vector<EndSection> sections;
};

/// An end of a vessel where the surface ends flat.
struct FlatEnd {
  /// Rank of the node among all ends of the centerline, from 1, whether or not they end flat.
  Index label = 0;
  Index node = kNone;          ///< of the centerline
  Vec3 center = Vec3::Zero();  ///< centroid of the cross-section, mm
  Vec3 normal = Vec3::Zero();  ///< out of the vessel
  double area = 0;             ///< of the cross-section, mm^2
  bool capped = false;         ///< else open
  bool at_section = false;     ///< the cross-section, before any extension, is that of FlatEndOptions::sections
  double extension = 0;        ///< length of the extension, in radii of the circle of that area
};

/// An extension for which there is not enough room: it runs into another vessel, or is left out (length 0).
struct BlockedExtension {
  Index node = kNone;      ///< of the centerline
  double length = 0;       ///< in radii of the circle of the end's area
  double longest = 0;      ///< there is room for, likewise
  Index branch = kNone;    ///< that is in the way, in find_branches()
  Vec3 at = Vec3::Zero();  ///< where it is in the way, mm
};

struct FlatEnds {
  std::vector<FlatEnd> ends;     ///< ascending in the nodes
  std::vector<Index> cap_label;  ///< of every face: the label of the end that it caps; 0: wall
  std::vector<SectionNotKept> not_kept;
  /// Nodes whose ends have less than the vessel's area, in spite of keep_area: with all of it, faces would cross.
  std::vector<Index> narrowed;
  std::vector<BlockedExtension> blocked;
};

/// What a user should know of ends that are not as asked for, a sentence each.
std::vector<std::string> problems_of(const FlatEnds& ends);

/// Extends and caps the openings of `result`, whose numbers are those of `centerline`. New faces are appended. Caps are
/// flat, with triangles about as large as those around them; closed openings are no longer listed. Check and defects
/// become those of the new surface; nodes are not tested again. Throws InvalidInput for a negative extension.
FlatEnds finish_ends(GenerateResult& result, const Centerline& centerline, const FlatEndOptions& options = {});

}  // namespace vmesh

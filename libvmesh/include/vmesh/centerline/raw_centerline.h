#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/centerline/end_section.h"

namespace vmesh {

enum class LengthUnit { unknown, nm, um, mm, cm, m };

/// Patient frames: x to the Left, y to the Posterior, z to the Superior (LPS), or Right, Anterior, Superior (RAS).
enum class Space { unknown, lps, ras };

/// "nm", "um", "mm", "cm", "m" or "unknown"; "LPS", "RAS" or "unknown".
std::string_view to_string(LengthUnit unit);
std::string_view to_string(Space space);

/// The reverse, in any case, also of names ("micrometer", "micron", "millimeter" ...); nullopt when not understood.
std::optional<LengthUnit> parse_length_unit(std::string_view text);
std::optional<Space> parse_space(std::string_view text);
/// The same of an option; throws InvalidInput with what there is.
LengthUnit require_length_unit(const std::string& text);
Space require_space(const std::string& text);

/// Millimetres in one unit. Throws InvalidInput for LengthUnit::unknown.
double millimetres_per(LengthUnit unit);

/// How near to each other ends of branches are joined: the larger of a distance and of a share of the radius at either.
struct EndTolerance {
  double mm = 0, radii = 0;
};

/// "0.5mm", or "0.1" for a tenth of the radius. Throws InvalidInput.
EndTolerance parse_end_tolerance(std::string_view text);

/// A centerline as read from a file, before it is checked or cleaned. Its content may be invalid in any way.
struct RawCenterline {
  std::vector<CenterlineNode> nodes;  ///< in `unit` and `space`; radius 0 where unknown
  std::vector<CenterlineSegment> segments;
  LengthUnit unit = LengthUnit::unknown;
  Space space = Space::unknown;
  std::vector<EndSection> end_sections;  ///< flat ends, in `unit` and `space`; nodes are those above

  /// First segments of polylines, ascending, when the file has polylines: the segments up to the next entry run head to
  /// tail. Empty when the file gives segments one by one.
  std::vector<Index> path_starts;
  /// The format only knows trees: points at the same position do not mean that a loop closes there.
  bool tree_only = false;
  /// Branches in this kind of file may stop short of their parent (see CleaningOptions::join_gaps).
  bool loose_branches = false;

  /// Ends of branches nearer than this are joined, as asked for; 0: none.
  EndTolerance join_ends = {};

  std::string source;                          ///< file name for messages
  std::string node_word = "node";              ///< what a node is called in the file: "line", "point", "nodes row" ...
  std::string segment_word = "segment";        ///< the same for segments
  std::vector<std::uint64_t> node_numbers;     ///< number of every node under that word; empty: its index
  std::vector<std::uint64_t> segment_numbers;  ///< the same for segments
  std::vector<std::string> radius_arrays;      ///< by name, what held the radii; empty if the format has one place
  std::vector<std::string> warnings;           ///< what the reader left out or assumed

  /// Where several files were merged, what each of them contributed, ascending; see merge(). Empty for a single file.
  struct Part {
    Index first_node, first_segment;
    std::string source, node_word, segment_word;
  };
  std::vector<Part> parts;

  /// "tree.swc: line 12": how messages name node `n` or segment `s`.
  std::string name_of_node(Index n) const;
  std::string name_of_segment(Index s) const;
  /// "line 12": the same without the file, or "line 12 of tree.swc" where there are several.
  std::string place_of_node(Index n) const;
  std::string place_of_segment(Index s) const;
};

/// Converts to millimetres and LPS. An override takes precedence over the file. If neither is known, millimetres or LPS
/// are assumed with a line in `warnings`; there is one as well when an override contradicts the file.
RawCenterline convert_to_internal(RawCenterline raw, std::optional<LengthUnit> unit_override,
                                  std::optional<Space> space_override, std::vector<std::string>& warnings);

/// Merges several files (one vessel each, say) into one centerline: side by side, for clean() to join where ends of
/// branches come close. Throws InvalidInput when there is none or when they disagree on unit or frame.
RawCenterline merge(std::vector<RawCenterline> files);

/// A hint if the radii (mm) are implausible for vessels: half of them below .05 or above 40 mm. nullopt if they are
/// plausible.
std::optional<std::string> implausible_radii(const RawCenterline& raw);

}  // namespace vmesh

// From a centerline to a finished surface, as the command and the Python package make it.
#pragma once

#include <functional>
#include <string_view>

#include "vmesh/production/prepared_centerline.h"
#include "vmesh/surface/flat_ends.h"

namespace vmesh {

/// How vessels end: in a hemisphere, with a flat cap, or open.
enum class EndShape { round, flat, open };

std::string_view to_string(EndShape shape);
/// Throws InvalidInput unless `text` is "round", "flat" or "open".
EndShape parse_end_shape(std::string_view text);

struct ProductionOptions {
  GenerateOptions growth;  ///< open_ends: those that are open whatever `ends` says
  PreparationOptions preparation;
  EndShape ends = EndShape::round;
  double extension = 0;         ///< length of straight extensions at ends that are not round, in radii; 0: none
  bool fit_extensions = false;  ///< make each only as long as there is room for it, see FlatEndOptions
};

/// Throws InvalidInput where an end that is to be open is none, or nothing is there to extend.
void check_ends(const ProductionOptions& options, const Centerline& centerline);

/// What may happen on the way. All are optional.
struct ProductionSteps {
  /// Called with the centerline that a surface is about to grow around: once more, for all nodes, if the surface around
  /// fewer was not sound.
  std::function<void(const PreparedCenterline&)> prepared;
  /// Grows the surface instead of generate_surface().
  std::function<GenerateResult(const Centerline&, const GenerateOptions&)> grow;
  /// Changes the surface while it refers to the centerline it was grown around, before its ends are finished. Returns
  /// whether it was fitted: rings are then left as they are.
  std::function<bool(GenerateResult&, const PreparedCenterline&)> refine;
};

/// A surface. Its numbers are those of the original centerline.
struct Production {
  GenerateResult result;
  FlatEnds ends;                  ///< those that are not round
  std::size_t wall_vertices = 0;  ///< before ends were capped or extended
  PreparedCenterline prepared;    ///< what it was grown around
};

/// Prepares the centerline, grows a surface (once more around all nodes if that around fewer is not sound), makes it
/// refer to the original, and finishes its ends: at `sections` in their planes. Whatever went wrong is in the result's
/// `defects` and `warnings`. Throws like generate_surface(), separate_contacts() and check_ends().
Production produce(const Centerline& centerline, const std::vector<EndSection>& sections,
                   const ProductionOptions& options = {}, const Progress& progress = {},
                   const ProductionSteps& steps = {});

}  // namespace vmesh

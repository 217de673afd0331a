#pragma once

#include <optional>
#include <vector>

#include "vmesh/centerline/end_section.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/contacts.h"

namespace vmesh {

/// The centerline around which a surface grows: without the nodes that it does not need, and with vessels that touched
/// narrowed or moved. Refers to the original, which must outlive it.
struct PreparedCenterline {
  const Centerline* original = nullptr;
  std::optional<SimplifiedCenterline> simplified;
  std::optional<SeparatedCenterline> separated;  ///< of the simplified one
  std::vector<Contact> kept_contacts;            ///< of the simplified one, where vessels are not separated

  const Centerline& unseparated() const { return simplified ? simplified->centerline : *original; }
  const Centerline& grown() const { return separated ? separated->centerline : unseparated(); }
  /// Before any were separated.
  const std::vector<Contact>& contacts() const { return separated ? separated->report.before : kept_contacts; }
};

struct PreparationOptions {
  bool simplify = true;  ///< leave nodes out, unless growth says not to
  bool separate = true;  ///< narrow vessels that touch, or move them apart; else contacts are only found
  double gap = 0.1;      ///< to be left between them, in smaller radii; in (0, 1]
};

/// Leaves nodes out as simplify_for_growth() does, unless growth.simplification is 0 or it is paper growth, and
/// separates vessels. Throws InvalidInput for options out of range, Cancelled.
PreparedCenterline prepare_centerline(const Centerline& original, const GenerateOptions& growth,
                                      const PreparationOptions& options, const Progress& progress = {});

/// Flat ends of the original with the numbers of the grown one's nodes.
std::vector<EndSection> sections_of_grown(const PreparedCenterline& prepared, std::vector<EndSection> sections);

/// Makes a surface around the grown centerline refer to the original.
void refer_to_original(const PreparedCenterline& prepared, GenerateResult& result);
/// The same for contacts of the simplified centerline, and for what separation did. Branches are the same.
void refer_to_original(const PreparedCenterline& prepared, std::vector<Contact>& contacts);
void refer_to_original(const PreparedCenterline& prepared, SeparationReport& report);

}  // namespace vmesh

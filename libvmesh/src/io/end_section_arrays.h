// Flat ends of a centerline as arrays that belong to a whole data set (VTK's field data); internal to the module.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmesh/centerline/raw_centerline.h"

#include "poly_lines.h"

namespace vmesh::io {

/// Numbers under a name, `components` to a tuple.
struct FieldArray {
  std::string name;
  int components = 1;
  bool integer = false;
  std::vector<double> values;
};

/// EndSectionNode, ...Center, ...Normal, ...Area, ...Open (1 or 0), one tuple for every section; the points of all
/// rings one after the other in EndSectionRing, of which those of section i begin at EndSectionRingOffsets[i] and end
/// before [i + 1]. None without sections.
std::vector<FieldArray> end_section_arrays(const std::vector<EndSection>& sections);

/// Whether an array of that name belongs to them.
bool is_end_section_array(std::string_view name);

/// The reverse: fills in raw.end_sections, whose nodes are given by raw.node_numbers. Throws InvalidInput for arrays
/// that do not fit together, points that are no node and sections that are wrong by themselves.
void read_end_sections(const ScalarArrays& field, RawCenterline& raw);

}  // namespace vmesh::io

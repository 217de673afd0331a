#pragma once

#include <optional>

#include "vmesh/production/produce.h"
#include "vmesh/skeleton/extract_centerline.h"
#include "vmesh/tuning/budget.h"

#include "command_line/arguments.h"

namespace vmesh::tool {

/// What ends are to be called.
struct EndNameArguments {
  std::vector<std::string> given;  ///< "3=inlet"
  std::filesystem::path table;     ///< CSV; empty: none

  bool empty() const { return given.empty() && table.empty(); }
};

struct GenerateArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  WritingArguments writing;
  ProductionOptions production;
  EndNameArguments end_names;    ///< of flat ends
  bool wall_by_branch = false;   ///< divide the wall's patch
  std::optional<Budget> budget;  ///< chooses growth.around, and max_error for a budget of error
  bool bones = false;            ///< add bones along the centerline to a .glb
  bool check = false;            ///< exit code 1 unless the surface is flawless
  bool allow_defects = false;    ///< write a surface even if it is not sound
  FittingArguments fitting;      ///< of the grown surface; without a reference, the image options apply to the input
  bool segmentation = false;     ///< the input is an image or a wall, from which a centerline is extracted
  ExtractOptions extraction;     ///< of that centerline
  RequiredCoverage required_coverage;
  std::filesystem::path centerline_output;  ///< file for it; empty: none
};

}  // namespace vmesh::tool

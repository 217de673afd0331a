// Arguments that several verbs have.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vmesh/fit/fit_surface.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/reference/reference_surface.h"

namespace vmesh::tool {

/// Options common to all verbs.
struct CommonArguments {
  bool quiet = false;
  bool slicer = false;         ///< called by 3D Slicer, see execution_model.h
  std::filesystem::path json;  ///< file for the summary; "-" for stdout, empty for none
  std::filesystem::path html;  ///< file for the page; empty for none. Not for all verbs
  std::string command_line;    ///< as it was typed, for the page
};

/// A centerline or surface file and how to read its numbers.
struct InputArguments {
  std::filesystem::path path;
  std::vector<std::filesystem::path> more;  ///< further files that form one centerline with it
  CenterlineReadOptions read;               ///< of centerlines
  std::optional<LengthUnit> unit;
  std::optional<Space> space;
  std::string options_of;  ///< prefix of these options' names: "reference-" for --reference-unit
};

/// How the numbers of an output are written.
struct WritingArguments {
  LengthUnit unit = LengthUnit::mm;
  Space space = Space::lps;
  std::string attributes = "all";  ///< of surfaces: "all", "vertex" or "none"
  SurfaceEncoding encoding = SurfaceEncoding::usual;

  bool operator==(const WritingArguments&) const = default;
};

/// A report on stdout and in a file.
struct ReportArguments {
  std::filesystem::path file;   ///< by its extension .txt, .md, .csv or .json; empty: none
  std::string format = "text";  ///< of stdout: text, markdown or csv
};

/// The target of a fit, and its options.
struct FittingArguments {
  InputArguments reference;  ///< surface or image; empty path: none
  ReferenceOptions image;    ///< how an image becomes a surface
  FitOptions options;
};

/// What an extracted centerline has to cover at least; 0: no requirement.
struct RequiredCoverage {
  double wall = 0;    ///< share of the wall's area
  double length = 0;  ///< share of the length of all paths
};

}  // namespace vmesh::tool

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "vmesh/centerline/raw_centerline.h"
#include "vmesh/centerline/synthetic_tree.h"
#include "vmesh/comparison/method_comparison.h"
#include "vmesh/fit/fit_surface.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/parts/part_files.h"
#include "vmesh/production/produce.h"
#include "vmesh/reference/reference_surface.h"
#include "vmesh/render/render.h"
#include "vmesh/skeleton/extract_centerline.h"
#include "vmesh/surface/generate.h"
#include "vmesh/tuning/budget.h"
#include "vmesh/tuning/tradeoff.h"

namespace vmesh::tool {

/// Options common to all verbs.
struct CommonArguments {
  bool quiet = false;
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

struct GenerateArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  WritingArguments writing;
  ProductionOptions production;
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

struct FitArguments {
  CommonArguments common;
  InputArguments input;       ///< surface
  InputArguments centerline;  ///< around which the surface was grown
  std::filesystem::path output;
  WritingArguments writing;
  FittingArguments fitting;
  std::optional<Budget> budget;  ///< sets the fit's max_vertices or its error
};

struct InfoArguments {
  CommonArguments common;
  InputArguments input;
  bool check = false;  ///< exit code 1 when the file has problems
};

struct SynthArguments {
  CommonArguments common;
  std::filesystem::path output;
  SyntheticTreeOptions options;
};

struct ConvertArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  WritingArguments writing;
};

struct RenderArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  RenderOptions options;
  std::string color;  ///< attribute to colour by, or "skewness"; empty: one colour
};

struct EvaluateArguments {
  CommonArguments common;
  InputArguments input;
  InputArguments reference;      ///< surface to compare with; empty path: none
  InputArguments centerline;     ///< whose volume to compare with; empty path: none
  std::filesystem::path output;  ///< the surface with distances and skewness; empty: none
  std::filesystem::path report;  ///< by extension; empty: none
  std::string format = "text";   ///< of stdout: text, markdown or csv
  std::string require;           ///< see parse_requirements()
  double tolerance_mm = 1e-4;    ///< of the Hausdorff distance
  std::size_t samples = 100'000;
  int threads = 0;  ///< 0: as many as there are
};

struct ReferenceArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  ReferenceOptions options;
  double voxel = 0;  ///< of a sampled centerline, mm; 0: not given
};

struct ConesArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  int sides = 18;
};

struct CenterlineArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  ExtractOptions options;
  ReferenceOptions image;   ///< which voxels of an image are inside
  bool each_label = false;  ///< a centerline of each label on its own
  RequiredCoverage required_coverage;
};

struct Table2Arguments {
  CommonArguments common;
  InputArguments reference;     ///< image or surface; empty path: the sampled volume of the centerline
  InputArguments centerline;    ///< empty path: extracted from the reference; without one, the synthetic tree
  ReferenceOptions image;       ///< how an image becomes the reference
  bool all_components = false;  ///< of the reference
  std::optional<double> voxel;  ///< of the sampled volume, mm; not given: as many vertices as the paper has
  ExtractOptions extraction;
  MethodOptions methods;
  std::filesystem::path surfaces;  ///< folder for them; empty: none
  std::filesystem::path report;    ///< by extension; empty: none
  std::string format = "text";     ///< of stdout: text, markdown or csv
  bool check = false;              ///< exit code 1 unless all demands are met
};

struct TradeoffArguments {
  CommonArguments common;
  InputArguments input;
  TradeoffOptions options;
  std::filesystem::path report;  ///< by extension; empty: none
  std::filesystem::path plot;    ///< SVG; empty: none
  std::string format = "text";   ///< of stdout: text, markdown or csv
};

struct DeformArguments {
  CommonArguments common;
  InputArguments input;
  InputArguments surface;
  std::filesystem::path script;
  std::filesystem::path output;  ///< folder
  std::string format = "vtp";    ///< extension of the frames
};

struct Table1Arguments {
  CommonArguments common;
  std::filesystem::path report;  ///< by extension; empty: none
  std::filesystem::path plot;    ///< .svg; empty: none
  std::string format = "text";   ///< of stdout: text, markdown or csv
};

struct SplitArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;  ///< folder
  double vertices = 1'000'000;   ///< approximate, of a part's surface
  GenerateArguments generate;    ///< its options of growth
};

struct JoinArguments {
  CommonArguments common;
  std::filesystem::path folder;
  std::filesystem::path output;
  int threads = 0;  ///< 0: as many as there are
};

using Arguments =
    std::variant<GenerateArguments, InfoArguments, SynthArguments, ConvertArguments, RenderArguments, EvaluateArguments,
                 ReferenceArguments, ConesArguments, CenterlineArguments, Table2Arguments, TradeoffArguments,
                 DeformArguments, Table1Arguments, FitArguments, SplitArguments, JoinArguments>;

/// Whether the file is a part of a surface to be grown, by its name.
bool is_part(const std::filesystem::path& path);

/// Named only where it is not 1.
inline constexpr std::string_view kElongationFlag = "--elongation";

/// Calls `visit(flag, member, low, high, help)` for every option of growth: the common list behind the command line and
/// the summary.
template <class Options, class Visitor>
void for_each_generate_option(Options& options, Visitor visit) {
  visit("--beta", options.beta, 0.0, 1.0, "attraction by the vessel wall against the vertex normal");
  visit("--blend", options.blend, 0.0, 2.0, "rounding at branches, in smaller radii; 0: plain union of round cones");
  visit("--around", options.around, 3, 200, "intended number of vertices around a vessel");
  visit("--max-center-distance", options.max_center_distance, 0.01, 10.0,
        "split faces whose centre is farther from the wall than this, in local radii");
  visit(kElongationFlag.data(), options.elongation, 1.0, double(kMostElongation),
        "along vessels, triangles as long as the error allows, at most so many times their even length; 1: even");
  visit("--simplification", options.simplification, 0.0, 1.0,
        "leave out nodes where that changes the vessels by at most this share of what edges across them cut off; 0: "
        "none");
  visit("--sweeps", options.sweeps, 0, 1000, "sweeps of the final optimisation; 0: leave the surface as grown");
  visit("--max-vertices", options.max_vertices, 100, 1'000'000'000,
        "refuse a centerline whose length and radii would need more than this");
}

/// Parses the command line. Returns nullopt if the command is finished with `exit_code`: help, version or a usage error
/// was printed.
std::optional<Arguments> parse_arguments(int argc, const char* const* argv, int& exit_code);

}  // namespace vmesh::tool

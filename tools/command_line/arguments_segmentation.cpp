#include "command_line/arguments_segmentation.h"

#include <cmath>
#include <sstream>

#include "vmesh/core/error.h"

#include "command_line/arguments_common.h"

namespace vmesh::tool {

void add_image_options(CLI::App& verb, ReferenceOptions& options) {
  CLI::Option* label =
      verb.add_option_function<std::vector<std::string>>(
              "--label",
              [&options](const std::vector<std::string>& words) {
                for (const std::string& word : words) {
                  double value = 0;
                  if (CLI::detail::lexical_cast(word, value)) {
                    options.labels.push_back(value);
                  } else {
                    options.segments.push_back(word);
                  }
                }
              },
              "image: voxels of this value are inside, or of these: 1,2,5; or segments of 3D Slicer by name")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->type_name("N,N,...");
  verb.add_option("--threshold", options.threshold, "image: voxels of at least this value are inside")->excludes(label);
  add_number(verb, "--spacing", options.spacing, 0.0, 1e6,
             "image: resample to cubic voxels of this side, mm; 0: do not resample");
  add_number(verb, "--smooth", options.smooth, 0.0, 1e6,
             "smooth with a Gaussian of this standard deviation, mm; 0: do not smooth");
}

void add_extraction(CLI::App& verb, ExtractOptions& options) {
  add_number(verb, "--step", options.spacing, 0.1, 10.0, "distance between nodes along a vessel, in local radii");
  add_number(verb, "--join", options.join, 0.0, 1e6,
             "join ends with what they point at over gaps of up to this times the smaller radius; 0: none");
  CLI::Option* largest = verb.add_flag("--largest", options.largest, "keep the longest component only");
  add_number(verb, "--least-length", options.least_length, 0.0, 1e9,
             "leave out components shorter than this, mm; 0: those no longer than wide")
      ->excludes(largest);
  verb.add_flag("--tree", options.tree, "open all loops, each at its thinnest contact");
  verb.add_flag(
      "--balanced-wall", options.balanced_wall,
      "the wall's faces, not its vertices, lie on the vessels' boundary in the mean, as in surfaces that vmesh "
      "grows");
}

void add_required_coverage(CLI::App& verb, RequiredCoverage& required) {
  verb.add_option_function<std::string>(
          "--require",
          [&required](const std::string& text) {
            std::istringstream list(text);
            for (std::string item; std::getline(list, item, ',');) {
              const std::size_t equals = item.find('=');
              const std::string name = item.substr(0, equals);
              double value = -1;
              const bool is_number =
                  equals != std::string::npos && CLI::detail::lexical_cast(item.substr(equals + 1), value);
              double* target = name == "coverage"          ? &required.wall
                               : name == "length-coverage" ? &required.length
                                                           : nullptr;
              if (target == nullptr || !is_number || !(value >= 0 && value <= 1))
                throw CLI::ValidationError(
                    "--require", "\"" + item + "\" is none of coverage=SHARE and length-coverage=SHARE, with 0 to 1");
              *target = value;
            }
          },
          "exit with 1 unless the extracted centerline covers this share of the wall (coverage=.98) or of the length "
          "of all vessels (length-coverage=.99)")
      ->type_name("NAME=SHARE,...");
}

void add_fitting(CLI::App& verb, FittingArguments& arguments) {
  add_reading(verb, arguments.reference, "reference-");
  add_voxel_size(verb, arguments.reference, "reference-");
  add_image_options(verb, arguments.image);
  add_read_option(
      verb, "--fit-error",
      [&arguments](const std::string& text) {
        constexpr std::string_view kMax = "max=";
        const bool is_max = text.starts_with(kMax);
        const ErrorLimit limit = parse_error_limit(is_max ? std::string_view(text).substr(kMax.size()) : text);
        if (std::isfinite(limit.relative)) throw InvalidInput("give millimetres, such as 0.3mm or max=0.5mm");
        (is_max ? arguments.options.max_error : arguments.options.error) = limit.mm;
      },
      "as many vertices as needed for 95 % of either surface to be nearer than this to the other; with max= all of it, "
      "but for regions that are listed, and proven")
      .type_name("Xmm|max=Xmm");
  add_number(verb, "--fit-rounds", arguments.options.rounds, 1, 100, "rounds of the fit");
  verb.add_flag("!--keep-triangles", arguments.options.resize,
                "only move the vertices; otherwise triangles become finer where the error is large, and coarser where "
                "it is small");
}

}  // namespace vmesh::tool

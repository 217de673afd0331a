// Options of growth.
#pragma once

#include <string_view>

#include "vmesh/production/produce.h"

namespace CLI {  // NOLINT(readability-identifier-naming): a library's
class App;
}

namespace vmesh::tool {

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
        "along vessels, triangles as long as the error allows, at most this times their even length; 1: even");
  visit("--simplification", options.simplification, 0.0, 1.0,
        "leave out nodes where that changes the vessels by at most this share of what edges across them cut off; 0: "
        "none");
  visit("--sweeps", options.sweeps, 0, 1000, "sweeps of the final optimisation; 0: leave the surface as grown");
  visit("--max-vertices", options.max_vertices, 100, 1'000'000'000,
        "refuse a centerline whose length and radii would need more than this");
}

/// Adds those that generate and split have in common.
void add_growth(CLI::App& verb, ProductionOptions& options);

}  // namespace vmesh::tool

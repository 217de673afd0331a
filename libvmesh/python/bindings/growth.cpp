#include "growth.h"

#include <algorithm>
#include <iterator>

#include "vmesh/production/notes.h"

#include "text.h"

namespace vmesh::python {
namespace {

void add(std::vector<std::string> notes, std::vector<std::string>& warnings) {
  std::move(notes.begin(), notes.end(), std::back_inserter(warnings));
}

void warn_of_budget(const Budget& budget, const std::vector<OperatingPoint>& tried,
                    std::vector<std::string>& warnings) {
  const auto keeps = [](const OperatingPoint& point) { return point.within_budget; };
  if (std::none_of(tried.begin(), tried.end(), keeps))
    warnings.push_back("nothing is within the budget " + to_string(budget) +
                       "; this is the closest surface: allow more, or check the radii");
}

void name_nodes(const CenterlineObject& centerline, std::vector<Defect>& defects) {
  for (Defect& defect : defects) {
    if (defect.node < centerline.place_of_node.size())
      defect.message += ", near " + centerline.place_of_node[defect.node];
    if (defect.branch != kNone) defect.message += ", on branch " + std::to_string(defect.branch);
  }
}

}  // namespace

SurfacePtr grow(const CenterlinePtr& centerline, ProductionOptions options, const std::optional<Budget>& budget,
                const Progress& progress) {
  options.preparation.simplify = !budget;  // which decides for every trial
  auto surface = std::make_shared<SurfaceObject>();
  std::vector<std::string>& warnings = surface->warnings;
  surface->centerline = centerline;
  ProductionSteps steps;
  steps.prepared = [&](const PreparedCenterline& prepared) { warnings = notes_on(prepared); };
  if (budget) {
    steps.grow = [&](const Centerline& grown, const GenerateOptions& growth) {
      BudgetedSurface within = generate_within(*budget, grown, growth, progress);
      options.growth.max_error = within.choice().options.max_error;
      surface->tried = std::move(within.tried);
      warn_of_budget(*budget, surface->tried, warnings);
      return std::move(within.result);
    };
  }
  Production production = produce(centerline->centerline, centerline->end_sections, options, progress, steps);
  surface->result = std::move(production.result);
  surface->ends = std::move(production.ends);
  GenerateResult& result = surface->result;
  for (const GrowthWarning& warning : result.warnings) warnings.push_back(warning.message);
  add(notes_on(result.error, options.growth.max_error), warnings);
  add(problems_of(surface->ends), warnings);
  name_nodes(*centerline, result.defects);
  return surface;
}

SurfacePtr with_finished_ends(const SurfaceObject& surface, const FlatEndOptions& options) {
  if (!surface.centerline) throw InvalidInput("the surface is not bound to a centerline whose ends could be finished");
  for (const Opening& opening : surface.result.openings) {
    if (opening.node == kNone)
      throw InvalidInput("for a surface from a file it is not known at which ends of the centerline its openings are");
  }
  auto result = std::make_shared<SurfaceObject>(surface);
  result->ends = finish_ends(result->result, surface.centerline->centerline, options);
  for (const std::string& problem : problems_of(result->ends)) result->warnings.push_back(problem);
  return result;
}

}  // namespace vmesh::python

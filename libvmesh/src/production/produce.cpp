#include "vmesh/production/produce.h"

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

/// With ends that are not round, all are grown open; those that were to be open whatever the shape stay so.
struct SettledEnds {
  EndShape shape = EndShape::round;
  OpenEnds grown_open;
  std::vector<Index> left_open;
};

SettledEnds settled(const ProductionOptions& options) {
  const OpenEnds& open = options.growth.open_ends;
  if (options.ends == EndShape::round) return {options.ends, open, {}};
  return {open.all ? EndShape::open : options.ends, {true, {}}, open.nodes};
}

FlatEnds finish(GenerateResult& result, const Centerline& centerline, const std::vector<EndSection>& sections,
                const ProductionOptions& options, const SettledEnds& ends, bool fitted) {
  if (result.openings.empty() && ends.shape == EndShape::round) return {};
  FlatEndOptions finishing;
  finishing.cap = ends.shape == EndShape::flat;
  finishing.left_open = ends.left_open;
  finishing.extension = options.extension;
  finishing.fit_extensions = options.fit_extensions;
  finishing.keep_area = options.growth.placement == Placement::balanced;
  finishing.fitted = fitted;
  finishing.sections = sections;
  return finish_ends(result, centerline, finishing);
}

}  // namespace

std::string_view to_string(EndShape shape) {
  return shape == EndShape::flat ? "flat" : shape == EndShape::open ? "open" : "round";
}

EndShape parse_end_shape(std::string_view text) {
  for (const EndShape shape : {EndShape::round, EndShape::flat, EndShape::open})
    if (text == to_string(shape)) return shape;
  throw InvalidInput("ends: \"" + std::string(text) + "\" is not known; there are round, flat and open");
}

void check_ends(const ProductionOptions& options, const Centerline& centerline) {
  const OpenEnds& open = options.growth.open_ends;
  if (options.extension > 0 && options.ends == EndShape::round && !open.all && open.nodes.empty())
    throw InvalidInput("flow extensions need ends that are not round: flat or open");
  for (const Index n : open.nodes) {
    if (n >= centerline.nodes().size() || centerline.degree(n) != 1)
      throw InvalidInput("node " + std::to_string(n) + " cannot be left open: it is not an end of the centerline");
  }
}

Production produce(const Centerline& centerline, const std::vector<EndSection>& sections,
                   const ProductionOptions& options, const Progress& progress, const ProductionSteps& steps) {
  check_ends(options, centerline);
  const SettledEnds ends = settled(options);
  GenerateOptions growth = options.growth;
  growth.open_ends = ends.grown_open;
  Production production;
  for (bool all_nodes = false;; all_nodes = true) {
    if (all_nodes) growth.simplification = 0;
    production.prepared = prepare_centerline(centerline, growth, options.preparation, progress);
    const PreparedCenterline& prepared = production.prepared;
    if (steps.prepared) steps.prepared(prepared);
    const GenerateOptions around = prepared.simplified ? after_simplification(growth, *prepared.simplified) : growth;
    production.result =
        steps.grow ? steps.grow(prepared.grown(), around) : generate_surface(prepared.grown(), around, progress);
    if (!prepared.simplified || production.result.is_sound()) break;
  }
  const bool fitted = steps.refine && steps.refine(production.result, production.prepared);
  refer_to_original(production.prepared, production.result);
  production.wall_vertices = production.result.mesh.vertices.size();
  production.ends = finish(production.result, centerline, sections, options, ends, fitted);
  return production;
}

}  // namespace vmesh

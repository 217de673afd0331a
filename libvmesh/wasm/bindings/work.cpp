#include "work.h"

#include <iterator>

#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/production/notes.h"
#include "vmesh/surface/surface_attributes.h"

#include "page/page_json.h"
#include "report/growth_content.h"
#include "report/page_content.h"

namespace vmesh::wasm {
namespace {

using tool::index_json;
using tool::list_json;
using tool::to_json;

void add(std::vector<std::string> notes, std::vector<std::string>& warnings) {
  std::move(notes.begin(), notes.end(), std::back_inserter(warnings));
}

void name_nodes(const CenterlineObject& centerline, std::vector<Defect>& defects) {
  for (Defect& defect : defects) {
    if (defect.node < centerline.place_of_node.size())
      defect.message += ", near " + centerline.place_of_node[defect.node];
  }
}

MeshAttributes attributes_of(const GenerateResult& result, const FlatEnds& ends, const Centerline& centerline) {
  MeshAttributes attributes =
      surface_attributes(result.mesh, result.binding, result.radius, result.openings, centerline);
  if (!ends.ends.empty()) add_cap_labels(ends, attributes);
  return attributes;
}

Json names_json(const std::vector<MeshAttribute>& attributes) {
  return list_json(attributes, [](const MeshAttribute& a) { return Json{{"name", a.name}, {"integer", a.integer}}; });
}

Json defect_json(const Defect& defect) {
  return {{"kind", to_string(defect.kind)},
          {"position", to_json(defect.position)},
          {"count", defect.count},
          {"node", index_json(defect.node)},
          {"message", defect.message}};
}

void add_facts(tool::Page& page, const SurfaceObject& surface) {
  const SkewnessSummary skewness = summarize_skewness(surface.result().mesh);
  page.facts = {{"Sound", surface.result().is_sound() ? "yes" : "no"},
                {"Vertices", std::to_string(surface.result().mesh.vertices.size())},
                {"Skewness, mean / max", tool::mean_and_max(skewness.mean, skewness.max)}};
  tool::add_facts_of(page, surface.deviation);
  page.facts.push_back({"Centerline", counted(surface.centerline->centerline.nodes().size(), "node")});
}

void add_places(tool::Page& page, const SurfaceObject& surface) {
  const tool::PageSurface& shown = page.surfaces.front();
  tool::add_defects(page, surface.result().defects);
  tool::add_farthest_from_vessels(page, surface.deviation, shown);
  tool::add_largest(page, shown, "EquiangleSkewness", "Skew triangle", "", tool::kMarksOfEach);
  tool::add_unproven(page, surface.result().error);
  const PreparedCenterline& prepared = surface.production.prepared;
  tool::add_contacts(page, prepared.contacts(), "Vessels touched");
  if (prepared.separated) tool::add_separation(page, prepared.separated->report);
}

}  // namespace

std::shared_ptr<const CenterlineObject> read(const ReadRequest& request) {
  LoadedCenterline loaded = load_centerline(request.paths, request.options);
  CenterlineObject object{std::move(loaded.cleaned.centerline), request.paths.front().filename().string()};
  for (const Index raw : loaded.cleaned.raw_node) object.place_of_node.push_back(loaded.file.place_of_node(raw));
  for (const CleaningAction& action : loaded.cleaned.report.actions) object.cleaning.push_back(action.message);
  object.warnings = std::move(loaded.warnings);
  object.end_sections = std::move(loaded.cleaned.end_sections);
  return std::make_shared<CenterlineObject>(std::move(object));
}

std::unique_ptr<SurfaceObject> generate(std::shared_ptr<const CenterlineObject> centerline,
                                        const ProductionOptions& options, const Progress& progress) {
  auto surface = std::make_unique<SurfaceObject>();
  surface->centerline = std::move(centerline);
  surface->options = options;
  const CenterlineObject& source = *surface->centerline;
  std::vector<std::string>& warnings = surface->warnings;
  ProductionSteps steps;
  steps.prepared = [&](const PreparedCenterline& prepared) { warnings = notes_on(prepared); };
  steps.refine = [&](GenerateResult& result, const PreparedCenterline& prepared) {
    const VesselField field(prepared.grown(), options.growth.blend);
    surface->deviation = measure_deviation(result.mesh, result.binding, field);
    return false;
  };
  surface->production = produce(source.centerline, source.end_sections, options, progress, steps);
  GenerateResult& result = surface->production.result;
  for (const GrowthWarning& warning : result.warnings) warnings.push_back(warning.message);
  add(notes_on(result.error, options.growth.max_error), warnings);
  add(problems_of(surface->production.ends), warnings);
  name_nodes(source, result.defects);
  surface->attributes = attributes_of(result, surface->production.ends, source.centerline);
  return surface;
}

Json describe(const CenterlineObject& object) {
  const Centerline& centerline = object.centerline;
  return {{"nodes", centerline.nodes().size()},
          {"segments", centerline.segments().size()},
          {"components", centerline.component_count()},
          {"loops", centerline.cycle_rank()},
          {"cleaning", object.cleaning},
          {"warnings", object.warnings}};
}

Json describe(const SurfaceObject& surface) {
  const GenerateResult& result = surface.result();
  return {{"vertices", result.mesh.vertices.size()},
          {"faces", result.mesh.faces.size()},
          {"sound", result.is_sound()},
          {"defects", list_json(result.defects, defect_json)},
          {"warnings", surface.warnings},
          {"unprovenFaces", result.error.unproven_faces},
          {"vertexAttributes", names_json(surface.attributes.vertex)},
          {"faceAttributes", names_json(surface.attributes.face)}};
}

Json page_about(const SurfaceObject& surface) {
  tool::Page page;
  page.title = surface.centerline->title;
  page.verb = "generate";
  page.command_line = "vmesh in the browser";
  page.options = surface.options_text;
  MeshAttributes attributes = surface.attributes;
  const VesselField field(surface.production.prepared.grown(), surface.options.growth.blend);
  tool::add_vessel_distances(surface.result(), field, surface.production.wall_vertices, attributes);
  page.surfaces.push_back({"surface", surface.result().mesh, std::move(attributes)});
  page.centerline = surface.centerline->centerline;
  page.warnings = surface.centerline->warnings;
  page.warnings.insert(page.warnings.end(), surface.warnings.begin(), surface.warnings.end());
  for (const Defect& defect : surface.result().defects) page.warnings.push_back(defect.message);
  add_facts(page, surface);
  add_places(page, surface);
  tool::add_histograms(page, page.surfaces.front());
  return tool::to_json(page);
}

}  // namespace vmesh::wasm

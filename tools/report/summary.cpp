#include "report/summary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "vmesh/centerline/branches.h"

#include "command_line/arguments_growth.h"
#include "command_line/outputs.h"
#include "report/exact_text.h"
#include "report/extraction_report.h"
#include "report/fit_report.h"

namespace vmesh::tool {
namespace {

using tool::to_json;

constexpr std::size_t kListedContacts = 1000;

/// "--max-center-distance" -> "max_center_distance"
std::string key_of(const char* flag) {
  std::string key = flag;
  key.erase(0, key.find_first_not_of('-'));
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

/// Null where there is no limit.
Json to_json(const ErrorLimit& limit) {
  return {{"mm", std::isfinite(limit.mm) ? Json(limit.mm) : Json()},
          {"relative", std::isfinite(limit.relative) ? Json(limit.relative) : Json()}};
}

const char* overlap_of(const GenerateArguments& arguments) {
  return arguments.production.preparation.separate ? "separate" : "keep";
}

Json options_json(const GenerateArguments& arguments) {
  Json json = Json::object();
  for_each_generate_option(arguments.production.growth, [&json](const char* flag, const auto& value, auto, auto,
                                                                const char*) { json[key_of(flag)] = value; });
  if (arguments.fitting.options.elongation > 1)
    json[key_of(kElongationFlag.data())] = arguments.fitting.options.elongation;
  json["growth"] = to_string(arguments.production.growth.growth);
  json["placement"] = to_string(arguments.production.growth.placement);
  json["max_error"] = to_json(arguments.production.growth.max_error);
  json["deformable"] = arguments.production.growth.deformable;
  json["overlap"] = overlap_of(arguments);
  json["gap"] = arguments.production.preparation.gap;
  json["ends"] = to_string(arguments.production.ends);
  json["flow_extensions"] = arguments.production.fit_extensions ? Json("auto") : Json(arguments.production.extension);
  json["unit"] = arguments.input.unit ? Json(to_string(*arguments.input.unit)) : Json();
  json["space"] = arguments.input.space ? Json(to_string(*arguments.input.space)) : Json();
  return json;
}

Json to_json(const Deviation& deviation) {
  return {{"mean_mm", deviation.mean_mm},
          {"rms_mm", deviation.rms_mm},
          {"max_mm", deviation.max_mm},
          {"mean_relative", deviation.mean_relative},
          {"rms_relative", deviation.rms_relative},
          {"max_relative", deviation.max_relative},
          {"max_at", to_json(deviation.max_at)}};
}

Json to_json(const ContactSide& side) {
  return {{"segment", side.segment},
          {"parameter", side.t},
          {"branch", index_json(side.branch)},
          {"radius_mm", side.radius}};
}

Json to_json(const Contact& contact) {
  const double smaller = std::min(contact.sides[0].radius, contact.sides[1].radius);
  return {{"at", to_json(contact.position)},
          {"depth_mm", contact.depth},
          {"depth_relative", contact.depth / smaller},
          {"vessels", list_json(contact.sides, [](const ContactSide& side) { return to_json(side); })}};
}

/// The deepest contacts, and how many there are in all.
Json to_json(const std::vector<Contact>& contacts) {
  return counted_json(
      contacts, [](const Contact& contact) { return to_json(contact); }, kListedContacts);
}

Json to_json(const VesselMove& move) {
  const double distance = move.displacement.norm();
  return {{"at", to_json(move.position)},  {"displacement_mm", to_json(move.displacement)},
          {"moved_mm", distance},          {"moved_relative", distance / move.moved.radius},
          {"vessel", to_json(move.moved)}, {"away_from", to_json(move.other)}};
}

/// The farthest moves, and how many there are in all.
Json to_json(const std::vector<VesselMove>& moves) {
  return counted_json(
      moves, [](const VesselMove& move) { return to_json(move); }, kListedContacts);
}

Json to_json(const SimplificationSummary& simplification) {
  return {{"nodes_left_out", simplification.nodes_left_out},
          {"max_deviation_mm", simplification.max_deviation},
          {"max_deviation_relative", simplification.max_deviation_relative}};
}

Json to_json(const SeparationReport& separation) {
  return {{"rounds", separation.rounds},
          {"nodes_narrowed", separation.nodes_narrowed},
          {"nodes_added", separation.nodes_added},
          {"max_taken_mm", separation.max_taken},
          {"max_taken_relative", separation.max_taken_relative},
          {"mean_taken_relative", separation.mean_taken_relative},
          {"max_taken_at", to_json(separation.max_taken_at)},
          {"nodes_moved", separation.nodes_moved},
          {"max_moved_mm", separation.max_moved},
          {"max_moved_relative", separation.max_moved_relative},
          {"max_moved_at", to_json(separation.max_moved_at)},
          {"steepest_move", separation.steepest_move},
          {"moves", to_json(separation.moves)},
          {"contacts_left", to_json(separation.left)}};
}

/// The centerline around which the surface was grown and with which it is compared.
std::string measured_centerline(const GenerateReport& report) {
  if (!report.separation || report.separation->nodes_narrowed + report.separation->nodes_moved == 0)
    return report.result->simplification.nodes_left_out > 0 ? "the simplified vessels" : "the vessels";
  return report.separation->nodes_moved > 0 ? "the narrowed and moved vessels" : "the narrowed vessels";
}

Json to_json(const OperatingPoint& point) {
  return {{"around", point.options.around},
          {"max_error", to_json(point.options.max_error)},
          {"vertices", point.vertices},
          {"seconds", point.seconds},
          {"skewness", tool::to_json(point.skewness)},
          {"distance", to_json(point.error)},
          {"within_budget", point.within_budget}};
}

Json budget_json(const Budget& budget, const GenerateOptions& chosen, const std::vector<OperatingPoint>& tried) {
  Json json = {{"budget", to_string(budget)}, {"met", false}, {"tried", Json::array()}};
  for (const OperatingPoint& point : tried) {
    json["tried"].push_back(to_json(point));
    if (point.options.around == chosen.around) json["met"] = point.within_budget;
  }
  return json;
}

Json wall_json(const WallDistance& wall) {
  return {{"area_mm2", wall.area},
          {"mean_mm", wall.mean},
          {"p95_mm", wall.percentile_95},
          {"max_mm", wall.max},
          {"max_at", to_json(wall.max_at)}};
}

}  // namespace

Json to_json(const Centerline& centerline) {
  double length = 0;
  for (Index s = 0; s < centerline.segments().size(); ++s) length += centerline.length(s);
  const auto [thin, thick] = std::minmax_element(centerline.nodes().begin(), centerline.nodes().end(),
                                                 [](const auto& a, const auto& b) { return a.radius < b.radius; });
  std::size_t isolated = 0, ends = 0, branch_nodes = 0;
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    const std::size_t degree = centerline.degree(n);
    isolated += degree == 0;
    ends += degree == 1;
    branch_nodes += degree > 2;
  }
  return {{"nodes", centerline.nodes().size()},
          {"segments", centerline.segments().size()},
          {"components", centerline.component_count()},
          {"loops", centerline.cycle_rank()},
          {"ends", ends},
          {"branches", find_branches(centerline).size()},
          {"branch_nodes", branch_nodes},
          {"isolated_nodes", isolated},
          {"radius_min_mm", thin->radius},
          {"radius_max_mm", thick->radius},
          {"length_mm", length},
          {"length_in_radii", centerline.length_in_radii()}};
}

Json to_json(const CleaningReport& report) {
  std::map<std::string, std::size_t> counts;
  for (const CleaningAction& action : report.actions) ++counts[std::string(to_string(action.kind))];
  Json joins = Json::array();
  for (const CleaningAction& action : report.actions) {
    if (action.kind == CleaningAction::Kind::joined_ends) joins.push_back(action.message);
  }
  return {{"counts", counts.empty() ? Json::object() : Json(counts)},
          {"actions", report.summary()},
          {"joined_ends", std::move(joins)}};
}

Json to_json(const SurfaceMeasurement& measurement) {
  const Topology& topology = measurement.topology;
  return {{"topology",
           {{"closed", topology.closed},
            {"manifold", topology.manifold},
            {"oriented", topology.oriented},
            {"outward", topology.outward},
            {"components", topology.components},
            {"genus", topology.genus},
            {"openings", measurement.openings},
            {"boundary_edges", topology.boundary_edges},
            {"euler_characteristic", topology.euler_characteristic}}},
          {"skewness", to_json(measurement.skewness)},
          {"metric_skewness", to_json(measurement.metric_skewness)},
          {"self_intersections", measurement.self_intersections}};
}

Json to_json(const std::vector<Defect>& defects) {
  return list_json(defects, [](const Defect& defect) {
    return Json{{"kind", to_string(defect.kind)},
                {"at", to_json(defect.position)},
                {"count", defect.count},
                {"segment", index_json(defect.segment)},
                {"branch", index_json(defect.branch)},
                {"node", index_json(defect.node)},
                {"message", defect.message}};
  });
}

// What is proven of the distance between the surface and the boundary, both ways.
Json error_bound_json(const GenerateArguments& arguments, const GenerateResult& result) {
  Json json = to_json(arguments.production.growth.max_error);
  json["proven"] = result.error.unproven_faces == 0;
  json["unproven_faces"] = result.error.unproven_faces;
  json["unproven_places"] = list_json(result.error.unproven_places, [](const UnprovenPlace& place) {
    return Json{{"at", to_json(place.position)}, {"faces", place.faces}};
  });
  json["closed_notches"] = list_json(result.error.closed_notches, [](const ClosedNotch& notch) {
    return Json{{"at", to_json(notch.position)}, {"depth_mm", notch.depth}, {"vertices", notch.vertices}};
  });
  return json;
}

Json slow_piece_json(const SlowPiece& piece) {
  return {{"position", to_json(piece.position)},
          {"vertices", piece.vertices},
          {"seconds", piece.seconds},
          {"times_median", piece.times},
          {"reason", piece.reason}};
}

Json stages_json(const std::vector<StageTime>& stages) {
  Json json = Json::object();
  double total = 0;
  for (const StageTime& stage : stages) {
    json[stage.stage] = json.value(stage.stage, 0.0) + stage.seconds;
    total += stage.seconds;
  }
  json["total"] = total;
  return json;
}

Json to_json(const GenerateReport& report) {
  const GenerateArguments& arguments = *report.arguments;
  const Centerline& centerline = report.cleaned->centerline;
  const TriMesh& mesh = report.result->mesh;
  const double size = centerline.length_in_radii();
  const SurfaceExpectation expected = expected_surface(centerline, *report.result);
  Json json = {
      {"schema", "vmesh.summary/1"},
      {"generator", generator_json()},
      {"input",
       {{"file", arguments.input.path.string()},
        {"sha256", report.input_sha256},
        {"radius_arrays", report.radius_arrays}}},
      {"output", arguments.output.string()},
      {"options", options_json(arguments)},
      {"centerline", to_json(centerline)},
      {"cleaning", to_json(report.cleaned->report)},
      {"simplification", to_json(report.result->simplification)},
      {"vertices", mesh.vertices.size()},
      {"faces", mesh.faces.size()},
      {"vertices_per_length_in_radii", size > 0 ? Json(static_cast<double>(mesh.vertices.size()) / size) : Json()}};
  json.update(to_json(report.measurement));
  json["topology"]["expected_components"] = expected.components;
  json["topology"]["expected_genus"] = expected.genus;
  json["openings"] = openings_json(*report.result);
  json["caps"] = caps_json(report.ends, report.end_names, report.wall_patches);
  json["growth"] = arguments.production.growth.growth == GrowthMethod::guided ? to_json(report.result->growth) : Json();
  json["nodes_inside"] = report.nodes_inside ? Json(*report.nodes_inside) : Json();
  json["nodes_inside_of"] = {{"centerline", measured_centerline(report)}, {"nodes", report.grown_nodes}};
  json["distance"] = to_json(report.deviation);
  json["distance"]["to"] = measured_centerline(report);
  json["rounding"] = to_json(report.rounding);
  if (arguments.production.growth.max_error.is_set()) json["error_bound"] = error_bound_json(arguments, *report.result);
  if (arguments.budget) json["budget"] = budget_json(*arguments.budget, arguments.production.growth, report.tried);
  if (report.fit) {
    json["fit"] = to_json(*report.fit);
    const std::filesystem::path& reference = arguments.fitting.reference.path;
    json["fit"]["reference"] = (reference.empty() ? arguments.input.path : reference).string();
  }
  json["contacts"] = to_json(report.contacts);
  if (report.separation) json["separation"] = to_json(*report.separation);
  if (report.extraction) json["extraction"] = to_json(*report.extraction);
  json["seconds"] = stages_json(report.stages);
  json["slow_pieces"] = list_json(report.result->growth.slow_pieces, slow_piece_json);  // beside: it differs as well
  json["warnings"] = report.warnings;
  json["sound"] = report.result->is_sound();
  json["defects"] = to_json(report.result->defects);
  json["problems"] = report.problems;
  return json;
}

Json to_json(const ExtractionReport& report) {
  Json branches = Json::array();
  for (std::size_t b = 0; b < report.branches.size(); ++b) {
    branches.push_back(wall_json(report.branches[b]));
    branches.back()["branch"] = b;
  }
  const auto of_gap = [](const JoinedGap& gap) {
    return Json{{"from", to_json(gap.from)}, {"to", to_json(gap.to)}, {"gap_mm", gap.gap}};
  };
  const auto of_loop = [](const VesselLoop& loop) {
    return Json{{"neck", to_json(loop.neck)},
                {"neck_radius_mm", loop.neck_radius},
                {"vessel_radius_mm", loop.radius},
                {"length_mm", loop.length},
                {"opened", loop.opened}};
  };
  const auto of_missed = [](const MissedWall& region) {
    return Json{{"place", to_json(region.place)},
                {"area_mm2", region.area},
                {"distance_mm", region.distance},
                {"reason", region.reason}};
  };
  return {{"components", report.components},
          {"left_out", report.left_out},
          {"spurs_removed", report.spurs},
          {"coverage", report.coverage},
          {"length_coverage", report.length_coverage},
          {"missed", list_json(report.missed, of_missed)},
          {"joined", list_json(report.joined, of_gap)},
          {"loops", list_json(report.loops, of_loop)},
          {"wall", wall_json(report.wall)},
          {"branches", branches},
          {"notes", report.notes}};
}

Json openings_json(const GenerateResult& result) {
  Json json = Json::array();
  for (std::size_t i = 0; i < result.openings.size(); ++i) {
    const Opening& opening = result.openings[i];
    json.push_back({{"label", i + 1},
                    {"node", opening.node},
                    {"center", to_json(opening.center)},
                    {"normal", to_json(opening.normal)},
                    {"radius", opening.radius},
                    {"vertices", opening.ring}});
  }
  return json;
}

Json caps_json(const FlatEnds& ends, const std::vector<EndName>& names, Index wall_patches) {
  return list_json(ends.ends, [&](const FlatEnd& end) {
    return Json{{"name", name_of_end(end, names)},
                {"cap_id", end.label},
                {"model_face_id", end.label + wall_patches},
                {"node", end.node},
                {"center", to_json(end.center)},
                {"normal", to_json(end.normal)},
                {"area_mm2", end.area},
                {"capped", end.capped},
                {"at_section", end.at_section},
                {"extension_radii", end.extension}};
  });
}

Json to_json(const std::vector<EndSection>& sections) {
  return list_json(sections, [](const EndSection& section) {
    return Json{{"node", section.node},
                {"center", to_json(section.center)},
                {"normal", to_json(section.normal)},
                {"area_mm2", section.area},
                {"open", section.open}};
  });
}

Json to_json(const GrowthSummary& growth) {
  const auto of_simplification = [](const GrowthSimplification& s) {
    return Json{{"kind", to_string(s.kind)},
                {"position", to_json(s.position)},
                {"nodes", s.nodes},
                {"segments", s.segments},
                {"message", s.message}};
  };
  return {{"junctions", growth.junctions},
          {"tubes", growth.tubes},
          {"components", growth.components},
          {"cycle_rank", growth.cycle_rank},
          {"pieces", growth.pieces},
          {"pieces_by_rung", growth.rungs},
          {"refused_steps",
           {{"degenerate", growth.refused.degenerate},
            {"axis", growth.refused.axis},
            {"crossing", growth.refused.crossing}}},
          {"simplifications", list_json(growth.simplifications, of_simplification)}};
}

void write_json(const std::filesystem::path& path, const Json& json) {
  if (path.empty()) return;
  write_text(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string describe(const GenerateArguments& arguments) {
  std::ostringstream text;
  for_each_generate_option(arguments.production.growth,
                           [&text](const char* flag, const auto& value, auto, auto, const char*) {
                             if (flag != kElongationFlag)
                               text << (text.tellp() > 0 ? " " : "") << flag << " " << exact_text(value);
                           });
  const GenerateOptions& options = arguments.production.growth;
  if (options.elongation > 1) text << " " << kElongationFlag << " " << exact_text(options.elongation);
  if (options.ring_spacing != 1) text << " --ring-spacing " << exact_text(options.ring_spacing);
  text << " --growth " << to_string(options.growth) << " --placement " << to_string(options.placement);
  if (options.deformable) text << " --deformable";
  if (options.max_error.is_set()) text << " --max-error " << to_string(options.max_error);
  if (options.least_vertices > 0) text << " --least-vertices " << options.least_vertices;
  if (arguments.production.ends != EndShape::round) text << " --ends " << to_string(arguments.production.ends);
  if (options.open_ends.all) text << " --open-ends all";
  const std::vector<Index>& open = options.open_ends.nodes;
  for (std::size_t i = 0; i < open.size(); ++i) text << (i == 0 ? " --open-ends " : ",") << open[i];
  if (arguments.production.fit_extensions) {
    text << " --flow-extensions auto";
  } else if (arguments.production.extension > 0) {
    text << " --flow-extensions " << exact_text(arguments.production.extension);
  }
  for (const std::string& name : arguments.end_names.given) text << " --name " << name;
  if (!arguments.end_names.table.empty()) text << " --names " << arguments.end_names.table.filename().string();
  if (arguments.wall_by_branch) text << " --regions branches";
  text << " --overlap " << overlap_of(arguments) << " --gap " << exact_text(arguments.production.preparation.gap);
  const std::filesystem::path& reference = arguments.fitting.reference.path;
  if (!reference.empty()) text << " --fit " << reference.string();
  if (!reference.empty() || arguments.segmentation) text << describe(arguments.fitting);
  if (arguments.segmentation) text << tool::describe(arguments.extraction);
  if (arguments.input.unit) text << " --unit " << to_string(*arguments.input.unit);
  if (arguments.input.space) text << " --space " << to_string(*arguments.input.space);
  return text.str();
}

}  // namespace vmesh::tool

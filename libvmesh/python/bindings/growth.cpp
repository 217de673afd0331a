#include "growth.h"

#include <algorithm>

#include "vmesh/volume/contacts.h"
#include "vmesh/volume/vessel_field.h"

#include "text.h"

namespace vmesh::python {
namespace {

constexpr std::size_t kNamed = 5;  // places, in a warning

/// With flat or open ends, all are grown open; those in `left_open` stay open.
struct SettledEnds {
  GenerateOptions options;
  EndShape shape;
  std::vector<Index> left_open;
};

SettledEnds settle(const GrowthRequest& request) {
  SettledEnds ends{request.options, request.ends, {}};
  OpenEnds& open = ends.options.open_ends;
  if (request.extension > 0 && ends.shape == EndShape::round && !open.all && open.nodes.empty())
    throw InvalidInput("flow_extension needs ends that are not round: ends=\"flat\" or \"open\"");
  if (ends.shape == EndShape::round) return ends;
  if (open.all) ends.shape = EndShape::open;
  ends.left_open = std::move(open.nodes);
  open = {true, {}};
  return ends;
}

void check_open_ends(const GrowthRequest& request, const Centerline& centerline) {
  for (const Index n : request.options.open_ends.nodes) {
    if (n >= centerline.nodes().size() || centerline.degree(n) != 1)
      throw InvalidInput("open_ends: node " + std::to_string(n) +
                         " cannot be left open: it is not an end of the centerline");
  }
}

void warn_of_contacts_left(const std::vector<Contact>& left, std::vector<std::string>& warnings) {
  for (std::size_t c = 0; c < std::min(kNamed, left.size()); ++c)
    warnings.push_back("vessels still touch " + describe(left[c]) +
                       "; neither narrowing nor a small move can part them: "
                       "move nodes of one, or join them if they are one vessel");
  if (left.size() > kNamed) warnings.push_back("vessels still touch in " + counted(left.size(), "place"));
}

void warn_of_contacts(const Centerline& centerline, const GrowthRequest& request, std::vector<std::string>& warnings) {
  const std::vector<Contact> contacts = find_contacts(ConeRelations(centerline, request.options.blend), request.gap);
  if (contacts.empty()) return;
  warnings.push_back("vessels that are not neighbours touch in " + counted(contacts.size(), "place") +
                     ", the deepest " + describe(contacts.front()) +
                     "; there the surface intersects itself (overlap=\"separate\", the default, moves them apart)");
}

void warn_of_error(const ErrorSummary& error, const ErrorLimit& limit, std::vector<std::string>& warnings) {
  if (error.unproven_faces == 0) return;
  warnings.push_back("the surface may be farther than " + to_string(limit) +
                     " from the boundary, or the boundary from it, at " + counted(error.unproven_faces, "face") +
                     " in " + counted(error.unproven_places.size(), "place") +
                     ": triangles are already as small as allowed; allow a larger error there, or check the radii");
}

std::optional<SimplifiedCenterline> simplify(const Centerline& centerline, const GenerateOptions& options) {
  if (options.growth == GrowthMethod::paper || options.simplification == 0) return std::nullopt;
  std::optional<SimplifiedCenterline> simplified = simplify_for_growth(centerline, options);
  if (!simplified->is_simpler()) return std::nullopt;
  return simplified;
}

/// Grows a surface around the centerline, or around the nodes kept by `simplified`.
GenerateResult grow_around(const Centerline& centerline, const std::optional<SimplifiedCenterline>& simplified,
                           const GenerateOptions& wanted, const GrowthRequest& request, const Progress& progress,
                           std::vector<std::string>& warnings) {
  const Centerline& steering = simplified ? simplified->centerline : centerline;
  const GenerateOptions options = simplified ? after_simplification(wanted, *simplified) : wanted;
  GenerateResult result;
  if (request.separate) {
    SeparationOptions separation;
    separation.gap = request.gap;
    separation.blend = options.blend;
    const SeparatedCenterline separated = separate_contacts(steering, separation, progress);
    warn_of_contacts_left(separated.report.left, warnings);
    result = generate_surface(separated.centerline, options, progress);
    refer_to_original(separated, steering, result);
  } else {
    warn_of_contacts(steering, request, warnings);
    result = generate_surface(steering, options, progress);
  }
  if (simplified) refer_to_original(*simplified, result);
  return result;
}

void name_nodes(const CenterlineObject& centerline, std::vector<Defect>& defects) {
  for (Defect& defect : defects) {
    if (defect.node < centerline.place_of_node.size())
      defect.message += ", nearest to " + centerline.place_of_node[defect.node];
    if (defect.branch != kNone) defect.message += ", on branch " + std::to_string(defect.branch);
  }
}

}  // namespace

EndShape parse_end_shape(const std::string& text) {
  if (text == "round") return EndShape::round;
  if (text == "flat") return EndShape::flat;
  if (text == "open") return EndShape::open;
  throw InvalidInput("ends: \"" + text + "\" is not known; there are round, flat and open");
}

SurfacePtr grow(const CenterlinePtr& centerline, const GrowthRequest& request, const Progress& progress) {
  const Centerline& c = centerline->centerline;
  check_open_ends(request, c);
  auto [options, shape, left_open] = settle(request);
  auto surface = std::make_shared<SurfaceObject>();
  surface->centerline = centerline;
  const auto simplified = simplify(c, options);
  surface->result = grow_around(c, simplified, options, request, progress, surface->warnings);
  if (simplified && !surface->result.is_sound()) {
    surface->warnings.clear();
    options.simplification = 0;
    surface->result = grow_around(c, std::nullopt, options, request, progress, surface->warnings);
  }
  GenerateResult& result = surface->result;
  for (const GrowthWarning& warning : result.warnings) surface->warnings.push_back(warning.message);
  warn_of_error(result.error, request.options.max_error, surface->warnings);
  if (shape != EndShape::round || !result.openings.empty()) {
    FlatEndOptions finish;
    finish.cap = shape == EndShape::flat;
    finish.left_open = left_open;
    finish.extension = request.extension;
    finish.keep_area = options.placement == Placement::balanced;
    finish.sections = centerline->end_sections;
    surface->ends = finish_ends(result, c, finish);
    for (const SectionNotKept& end : surface->ends.not_kept)
      surface->warnings.push_back("the flat end at node " + std::to_string(end.node) + " is not kept: " + end.reason +
                                  "; the vessel is cut across its axis there");
  }
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
  return result;
}

}  // namespace vmesh::python

#include "report/generate_log.h"

#include <algorithm>

#include "vmesh/core/text.h"

namespace vmesh::tool {
namespace {

std::string number(double value, int digits = 3) { return formatted("%.*f", digits, value); }

std::string percent(double share) { return number(100 * share, 0) + " %"; }

std::string text_of(const Vec3& p) { return "(" + number(p.x()) + ", " + number(p.y()) + ", " + number(p.z()) + ")"; }

std::string places(const std::vector<Contact>& contacts) { return counted(contacts.size(), "place", "places"); }

void tell_of_notches(const ErrorSummary& error, Console& console) {
  if (error.closed_notches.empty()) return;
  const ClosedNotch& deepest = error.closed_notches.front();
  console.log(counted(error.closed_notches.size(), "notch", "notches") +
              " too narrow for triangles closed, which the limit accounts for: the deepest by " +
              number(deepest.depth) + " mm at " + text_of(deepest.position));
}

/// Of those that were fitted.
void tell_of_extensions(const GenerateReport& report, Console& console) {
  const std::vector<FlatEnd>& ends = report.ends.ends;
  if (!report.arguments->production.fit_extensions || ends.empty()) return;
  const auto [shortest, longest] = std::minmax_element(
      ends.begin(), ends.end(), [](const FlatEnd& a, const FlatEnd& b) { return a.extension < b.extension; });
  console.log("flow extensions of " + number(shortest->extension, 2) + " to " + number(longest->extension, 2) +
              " radii, at node " + std::to_string(shortest->node) + " the shortest");
}

void log_simplification(const SimplifiedCenterline& simplified, Console& console) {
  console.log(std::to_string(simplified.node.size()) + " of the nodes steer the surface; leaving out the others " +
              "changes the vessels by at most " + number(100 * simplified.max_deviation_relative, 1) +
              " % of their radius");
}

void log_separation(const SeparationReport& separation, Console& console) {
  if (separation.nodes_narrowed > 0) {
    console.log("vessels that are not neighbours touched in " + places(separation.before) + "; " +
                std::to_string(separation.nodes_narrowed) + " nodes were narrowed, by " +
                percent(separation.mean_taken_relative) + " of the radius on average, " +
                percent(separation.max_taken_relative) + " (" + number(separation.max_taken) + " mm) at most");
  }
  if (separation.nodes_moved > 0) {
    console.log("vessels were moved aside in " + counted(separation.moves.size(), "place", "places") +
                " where they cross or nearly do: " + std::to_string(separation.nodes_moved) + " nodes, by " +
                number(separation.max_moved) + " mm, " + number(separation.max_moved_relative, 2) +
                " radii at most, the farthest at " + text_of(separation.max_moved_at));
  }
}

void warn_of_contacts(GenerateReport& report, Console& console) {
  warn(report,
       "vessels that are not neighbours touch in " + places(report.contacts) + ", the deepest " +
           describe(report.contacts.front()) +
           "; there the surface intersects itself, and is refused unless --allow-defects (--overlap separate, the "
           "default, narrows them, and moves those that cross)",
       console);
}

void warn_of_contacts_left(GenerateReport& report, const std::vector<Contact>& left, Console& console) {
  constexpr std::size_t kNamed = 5;
  for (std::size_t c = 0; c < std::min(kNamed, left.size()); ++c) {
    warn(report,
         "vessels still touch " + describe(left[c]) +
             "; neither narrowing nor a small move can part them: move nodes of one, or join them if they are one "
             "vessel",
         console);
  }
  if (left.size() > kNamed)
    warn(report, "vessels still touch in " + places(left) + "; the summary lists them", console);
}

}  // namespace

void log_preparation(const PreparedCenterline& prepared, GenerateReport& report, Console& console) {
  if (prepared.simplified) log_simplification(*prepared.simplified, console);
  report.contacts = prepared.contacts();
  if (!prepared.separated) {
    if (!report.contacts.empty()) warn_of_contacts(report, console);
    return;
  }
  report.separation = prepared.separated->report;
  log_separation(*report.separation, console);
  warn_of_contacts_left(report, report.separation->left, console);
}

void log_choice(const BudgetedSurface& surface, const GenerateArguments& arguments, Console& console) {
  console.log("for " + to_string(*arguments.budget) + " these were tried:");
  for (const OperatingPoint& point : surface.tried) {
    const double spacing = point.options.ring_spacing;
    console.log(std::string(&point == &surface.choice() ? "* " : "  ") + std::to_string(point.options.around) +
                " around" + (spacing == 1 ? "" : ", rings " + number(spacing) + " times as far apart") + ": " +
                std::to_string(point.vertices) + " vertices, " + number(point.seconds) + " s, distance " +
                number(point.error.mean_relative) + " mean, " + number(point.error.max_relative) + " max (" +
                number(point.error.max_mm) + " mm), skewness " + number(point.skewness.mean) + " mean, " +
                number(point.skewness.max) + " max" + (point.within_budget ? "" : "; beyond the budget"));
  }
  std::string inputs = arguments.input.path.string();
  for (const std::filesystem::path& path : arguments.input.more) inputs += " " + path.string();
  console.log("the same again: vmesh generate " + inputs + " -o " + arguments.output.string() + " " +
              describe(arguments));
}

void log_result(const GenerateReport& report, Console& console) {
  const TriMesh& mesh = report.result->mesh;
  const double size = report.cleaned->centerline.length_in_radii();
  std::string vertices = std::to_string(mesh.vertices.size()) + " vertices";
  if (size > 0)
    vertices += " (" + number(static_cast<double>(mesh.vertices.size()) / size, 1) + " per radius of length)";
  console.log(vertices + ", " + std::to_string(mesh.faces.size()) + " faces, skewness " +
              number(report.measurement.skewness.mean) + " mean, " + number(report.measurement.skewness.max) + " max");
  if (!report.result->elongation.empty())
    console.log("as if even along the vessels, skewness " + number(report.measurement.metric_skewness.mean) +
                " mean, " + number(report.measurement.metric_skewness.max) + " max");
  console.log("distance to the volume " + number(report.deviation.mean_relative) + " mean, " +
              number(report.deviation.max_relative) + " max, in local radii");
  const ErrorLimit& limit = report.arguments->production.growth.max_error;
  if (limit.is_set() && report.result->error.unproven_faces == 0)
    console.log("proven: nowhere farther than " + to_string(limit) + " from the boundary, nor the boundary from it");
  tell_of_notches(report.result->error, console);
  tell_of_extensions(report, console);
  double total = 0;
  for (const StageTime& stage : report.stages) total += stage.seconds;
  console.log("wrote " + report.arguments->output.string() + " after " + number(total, 2) + " s");
}

void warn(GenerateReport& report, const std::string& text, Console& console) {
  console.warn(text);
  report.warnings.push_back(text);
}

void warn_of_error(GenerateReport& report, Console& console) {
  const ErrorSummary& error = report.result->error;
  if (error.unproven_faces == 0) return;
  constexpr std::size_t kNamed = 5;
  std::string text = "the surface may be farther than " + to_string(report.arguments->production.growth.max_error) +
                     " from the boundary, or the boundary from it, at " + std::to_string(error.unproven_faces) +
                     " faces in " + std::to_string(error.unproven_places.size()) + " places, the largest at ";
  for (std::size_t i = 0; i < std::min(kNamed, error.unproven_places.size()); ++i)
    text += (i > 0 ? ", " : "") + text_of(error.unproven_places[i].position);
  text += ": triangles are already as small as allowed; allow a larger error there, or check the radii";
  warn(report, text, console);
}

void log_refusal(const GenerateReport& report, Console& console) {
  std::vector<std::string> lines;
  for (const Defect& defect : report.result->defects)
    lines.push_back(std::string(to_string(defect.kind)) + ": " + defect.message);
  const std::string cure = report.ends.blocked.empty()
                               ? "check the radii and nodes there, try another --around or --blend"
                               : "shorten the flow extensions, or give --flow-extensions auto, which makes each as "
                                 "long as there is room";
  log_refusal(lines,
              report.arguments->input.path.string() + ": no sound surface was found, nothing is written: " + cure +
                  ", or write the surface as it is with --allow-defects",
              console);
}

void log_refusal(const std::vector<std::string>& defects, const std::string& what_to_do, Console& console) {
  constexpr std::size_t kNamed = 8;
  for (std::size_t i = 0; i < std::min(kNamed, defects.size()); ++i) console.error(defects[i]);
  if (defects.size() > kNamed) console.error("and " + std::to_string(defects.size() - kNamed) + " more defects");
  console.error(what_to_do);
}

}  // namespace vmesh::tool

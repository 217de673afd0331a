#include "report/extraction_report.h"

#include <sstream>
#include <string>

#include "vmesh/core/text.h"

#include "report/exact_text.h"

namespace vmesh::tool {
namespace {

std::string place(const Vec3& p) { return formatted("(%.4g, %.4g, %.4g)", p.x(), p.y(), p.z()); }

std::string three_digits(double value) { return formatted("%.3g", value); }

void log_size(const ExtractedCenterline& extracted, Console& console) {
  const Centerline& centerline = extracted.centerline;
  const ExtractionReport& report = extracted.report;
  std::size_t ends = 0;
  for (Index n = 0; n < centerline.nodes().size(); ++n) ends += centerline.degree(n) == 1;
  console.log(std::to_string(centerline.nodes().size()) + " nodes, " +
              counted(centerline.component_count(), "component, ", "components, ") + counted(ends, "end", "ends") +
              (extracted.end_sections.empty() ? "" : " (" + std::to_string(extracted.end_sections.size()) + " flat)") +
              ", " + counted(centerline.cycle_rank(), "loop", "loops"));
  console.log(formatted("coverage %.4f of the wall, %.4f of the length; wall to the vessels' boundary ",
                        report.coverage, report.length_coverage) +
              three_digits(report.wall.mean) + " mm mean, " + three_digits(report.wall.percentile_95) + " at 95 %, " +
              three_digits(report.wall.max) + " max at " + place(report.wall.max_at));
}

/// One line for all of a kind, with the largest.
void warn_of_missed(const ExtractionReport& report, Console& console) {
  if (report.missed.empty()) return;
  double area = 0;
  for (const MissedWall& missed : report.missed) area += missed.area;
  const MissedWall& largest = report.missed.front();
  if (report.coverage > 0.999) return;
  console.warn(counted(report.missed.size(), "region", "regions") + " of the wall, " + three_digits(area) +
               " mm2, beyond the vessels' reach; the largest, " + three_digits(largest.area) + " mm2, up to " +
               three_digits(largest.distance) + " mm off, at " + place(largest.place) + ": " + largest.reason);
}

void warn_of_components(const ExtractionReport& report, Console& console) {
  if (report.left_out == 0) return;
  console.warn(std::to_string(report.left_out) + " of " + std::to_string(report.components) +
               " components left out: no longer than wide or than noise, or by --largest or --least-length");
}

void log_joined(const ExtractionReport& report, Console& console) {
  if (report.joined.empty()) return;
  const JoinedGap* widest = &report.joined.front();
  for (const JoinedGap& gap : report.joined)
    if (gap.gap > widest->gap) widest = &gap;
  console.log(counted(report.joined.size(), "gap", "gaps") + " joined, the widest of " + three_digits(widest->gap) +
              " mm at " + place(widest->from));
}

void log_loops(const ExtractionReport& report, Console& console) {
  if (report.loops.empty()) return;
  const VesselLoop& loop = report.loops.front();
  console.log(counted(report.loops.size(), "loop", "loops") + (loop.opened ? " opened" : "") +
              "; the thinnest neck beside its vessels has a radius of " + three_digits(loop.neck_radius) +
              " mm, where they have " + three_digits(loop.radius) + ", at " + place(loop.neck) +
              (loop.opened ? "" : "; --tree opens loops at their necks"));
}

}  // namespace

std::string describe(const ReferenceOptions& image) {
  std::ostringstream text;
  const char* before = " --label ";
  for (const double label : image.labels) text << std::exchange(before, ",") << label;
  for (const std::string& name : image.segments) text << std::exchange(before, ",") << '"' << name << '"';
  if (image.threshold) text << " --threshold " << *image.threshold;
  if (image.spacing > 0) text << " --spacing " << image.spacing;
  if (image.smooth > 0) text << " --smooth " << image.smooth;
  return text.str();
}

std::string describe(const ExtractOptions& options) {
  std::ostringstream text;
  text << " --step " << exact_text(options.spacing) << " --join " << exact_text(options.join);
  if (options.largest) text << " --largest";
  if (options.least_length > 0) text << " --least-length " << exact_text(options.least_length);
  if (options.tree) text << " --tree";
  if (options.balanced_wall) text << " --balanced-wall";
  return text.str();
}

void log_extraction(const ExtractedCenterline& extracted, Console& console) {
  for (const std::string& note : extracted.report.notes) console.log(note);
  log_size(extracted, console);
  log_loops(extracted.report, console);
  log_joined(extracted.report, console);
  warn_of_components(extracted.report, console);
  warn_of_missed(extracted.report, console);
}

}  // namespace vmesh::tool

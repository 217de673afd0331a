// Splitting a surface that is still to be grown into parts.
#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "vmesh/core/ascending.h"
#include "vmesh/core/error.h"
#include "vmesh/surface/part.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/input/buried_branches.h"
#include "surface/input/size_check.h"
#include "surface/pieces/division.h"
#include "surface/remesh/optimize.h"

namespace vmesh {
namespace {

// Radii around the walls of a part within which it knows other vessels. Derived: more than any stage asks for, half a
// radius at most (kClear of division.cpp), and more than the radius and a half in which a cone's company is looked for.
constexpr double kReach = 3;

void check_parts_suffice(const GenerateOptions& options) {
  const auto refuse = [](const char* what) {
    throw Unsupported(std::string(what) + ": generate the surface in one go, it cannot be made in parts");
  };
  if (options.growth == GrowthMethod::paper) refuse("paper growth starts from a single seed");
  if (options.max_error.is_set()) refuse("a limit on the error is proven of the whole");
  if (options.elongation > 1) refuse("elongated triangles are told from bad ones on the whole");
  if (options.open_ends.all || !options.open_ends.nodes.empty()) refuse("open ends are finished on the whole");
}

// Rings are laid for one branch after the other, and forgotten.
Division divide_scanning(const VesselAxes& axes, const GenerateOptions& options, std::vector<Index>& counts,
                         const Progress& progress) {
  counts.resize(axes.axes().size());
  std::vector<std::vector<RingPlace>> found(counts.size());
  tbb::parallel_for(std::size_t{0}, counts.size(), [&](std::size_t i) {
    report_progress(progress, "divide", 0);
    const auto b = static_cast<Index>(i);
    const Rings laid = axes.layer().lay(b);
    counts[b] = static_cast<Index>(laid.rings.size());
    found[b] = find_seams(axes, options, b, laid.rings);
  });
  std::vector<RingPlace> seams;
  for (const auto& of_branch : found) seams.insert(seams.end(), of_branch.begin(), of_branch.end());
  return divide(RingCounts(axes, counts), std::move(seams));
}

class PartMaker {
 public:
  PartMaker(const VesselAxes& axes, const RingCounts& rings, const Division& division, const GenerateOptions& options)
      : axes_(axes), rings_(rings), division_(division), options_(options) {
    const Centerline& centerline = axes.centerline();
    for (Index n = 0; n < centerline.nodes().size(); ++n) {
      if (centerline.degree(n) == 0) isolated_.push_back(n);
    }
  }

  // Numbers of pieces that begin parts, and the end: parts of about as many rings each.
  std::vector<Index> beginnings(std::size_t parts) const {
    std::vector<double> size = {0};  // up to every piece
    for (const PiecePlan& plan : division_.plans) {
      double rings = static_cast<double>(plan.nodes.size());
      for (const Stretch& stretch : plan.stretches) rings += stretch.count;
      size.push_back(size.back() + rings);
    }
    std::vector<Index> first = {0};
    for (std::size_t k = 1; k < parts; ++k) {
      const double until = size.back() * static_cast<double>(k) / static_cast<double>(parts);
      const auto piece = static_cast<Index>(std::lower_bound(size.begin(), size.end(), until) - size.begin());
      if (piece > first.back() && piece < division_.plans.size()) first.push_back(piece);
    }
    first.push_back(static_cast<Index>(division_.plans.size()));
    return first;
  }

  SurfacePart make(Index first, Index end) const {
    SurfacePart part;
    part.options = options_;
    part.first_piece = first;
    const std::vector<Index> branches = branches_of(first, end);
    part.field = axes_.field().excerpt(cones_of(branches, first, end), kReach);
    for (const Index b : branches) part.branches.push_back(as_in(part.field, axes_.axes()[b].branch()));
    for (Index p = first; p < end; ++p) {
      PiecePlan plan = division_.plans[p];
      for (const RingPlace& seam : seams_of(rings_, plan))
        part.seams.push_back({{place_in(branches, seam.branch), seam.ring}, number_of(seam)});
      for (Index& n : plan.nodes) n = place_in(part.field.node, n);
      for (Stretch& s : plan.stretches) s.branch = place_in(branches, s.branch);
      part.pieces.push_back(std::move(plan));
    }
    merge(part.seams);
    return part;
  }

 private:
  Index number_of(const RingPlace& seam) const {
    const auto it = std::lower_bound(division_.seams.begin(), division_.seams.end(), seam);
    return static_cast<Index>(it - division_.seams.begin());
  }

  std::vector<Index> branches_of(Index first, Index end) const {
    std::vector<Index> branches;
    for (Index p = first; p < end; ++p) {
      for (const Stretch& s : division_.plans[p].stretches) branches.push_back(s.branch);
    }
    sort_unique(branches);
    return branches;
  }

  // All along the branches, and what begins where they end: how a vessel is seen at its end depends on what is there.
  std::vector<Index> cones_of(const std::vector<Index>& branches, Index first, Index end) const {
    const Centerline& centerline = axes_.centerline();
    std::vector<Index> cones;
    for (const Index b : branches) {
      const Branch& branch = axes_.axes()[b].branch();
      cones.insert(cones.end(), branch.segments.begin(), branch.segments.end());
      for (const Index n : {branch.nodes.front(), branch.nodes.back()}) {
        const auto incident = centerline.incident_segments(n);
        cones.insert(cones.end(), incident.begin(), incident.end());
      }
    }
    for (Index p = first; p < end; ++p) {
      for (const Index n : division_.plans[p].nodes) {
        if (centerline.degree(n) == 0)
          cones.push_back(static_cast<Index>(centerline.segments().size() + place_in(isolated_, n)));
      }
    }
    sort_unique(cones);
    return cones;
  }

  static Branch as_in(const FieldExcerpt& field, const Branch& branch) {
    Branch result;
    for (const Index n : branch.nodes) result.nodes.push_back(place_in(field.node, n));
    for (const Index s : branch.segments) result.segments.push_back(place_in(field.cone, s));
    return result;
  }

  // A seam between two of the part's pieces was added for both.
  static void merge(std::vector<SurfacePart::Seam>& seams) {
    std::sort(seams.begin(), seams.end(), [](const auto& a, const auto& b) { return a.place < b.place; });
    const auto same = [](const auto& a, const auto& b) { return a.place == b.place; };
    seams.erase(std::unique(seams.begin(), seams.end(), same), seams.end());
  }

  const VesselAxes& axes_;
  const RingCounts& rings_;
  const Division& division_;
  const GenerateOptions& options_;
  std::vector<Index> isolated_;  // nodes
};

// From numbers of the growth centerline to those of the one that was split.
void renumber(const GrowthCenterline& growth, SurfacePart& part) {
  if (growth.buried.empty()) return;
  for (Index& n : part.field.node) n = growth.node[n];
  for (Index& c : part.field.cone) c = growth.cone[c];
}

SplitSummary split(const Centerline& centerline, const GenerateOptions& options, double vertices,
                   const std::function<void(SurfacePart)>& take, const Progress& progress) {
  std::optional<VesselField> field(std::in_place, centerline, options.blend);
  const GrowthCenterline growth = without_buried_branches(*field);
  if (!growth.buried.empty()) field.emplace(growth.centerline, options.blend);
  SplitSummary summary;
  summary.options = options;
  summary.components = field->centerline().component_count();
  summary.cycle_rank = field->centerline().cycle_rank();
  summary.expected_vertices = expected_vertices(centerline, options.around);
  summary.simplifications = notes_of_buried(growth, centerline);

  const VesselAxes axes(*field, RingOptions::of(options));
  std::vector<Index> counts;
  const Division division = divide_scanning(axes, options, counts, progress);
  const RingCounts rings(axes, std::move(counts));
  summary.pieces = division.plans.size();
  summary.seams = division.seams.size();
  const PartMaker maker(axes, rings, division, options);
  const double parts = std::clamp(std::round(summary.expected_vertices / vertices), 1.0, double(summary.pieces));
  const std::vector<Index> first = maker.beginnings(static_cast<std::size_t>(parts));
  summary.parts = first.size() - 1;
  for (std::size_t p = 0; p < summary.parts; ++p) {
    report_progress(progress, "split", static_cast<double>(p) / static_cast<double>(summary.parts));
    SurfacePart part = maker.make(first[p], first[p + 1]);
    renumber(growth, part);
    take(std::move(part));
  }
  return summary;
}

}  // namespace

SplitSummary split_surface(const Centerline& centerline, const GenerateOptions& given, double vertices,
                           const std::function<void(SurfacePart)>& take, const Progress& progress) {
  const GenerateOptions options = settled(given, centerline);
  check_parts_suffice(options);
  if (!(vertices >= 1)) throw InvalidInput("a part must have vertices");
  SplitSummary summary;
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  arena.execute([&] { summary = split(centerline, options, vertices, take, progress); });
  return summary;
}

}  // namespace vmesh

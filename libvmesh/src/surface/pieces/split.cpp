// Splitting a surface into parts before it is grown.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "vmesh/core/ascending.h"
#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"
#include "vmesh/surface/part.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/finish/optimize.h"
#include "surface/input/buried_branches.h"
#include "surface/input/size_check.h"
#include "surface/pieces/division.h"

namespace vmesh {
namespace {

// Radii around the walls of a part within which it knows other vessels. Derived: more than any stage asks for, less
// than a radius (kClear of division.cpp, the gap looked for in balance.cpp), and more than the radius and a half in
// which a cone's company is looked for.
constexpr double kReach = 2;

void check_parts_suffice(const GenerateOptions& options) {
  const auto refuse = [](const char* what) {
    throw Unsupported(std::string(what) + "; this surface cannot be made in parts, generate it in one go");
  };
  if (options.growth == GrowthMethod::paper) refuse("paper growth starts from a single seed");
  if (options.max_error.is_set()) refuse("a limit on the error is proven on the whole surface");
  if (options.open_ends.all || !options.open_ends.nodes.empty()) refuse("open ends are finished on the whole surface");
}

// Segments of a chunk: a field is made around that number at a time. More take more memory, fewer more time at their
// borders.
constexpr std::size_t kChunk = 25'000;

// The branches of the whole centerline.
class WholeBranches {
 public:
  explicit WholeBranches(const FieldExcerpts& excerpts)
      : excerpts_(excerpts), branches_(excerpts.relations().centerline()) {}

  const ConeRelations& relations() const { return excerpts_.relations(); }
  const Centerline& centerline() const { return relations().centerline(); }
  std::size_t size() const { return branches_.size(); }

  // The cones along a branch and those that begin where it ends: the field at a vessel's end depends on them.
  void add_cones(Index branch, std::vector<Index>& cones) const {
    const auto segments = branches_.segments(branch);
    cones.insert(cones.end(), segments.begin(), segments.end());
    const auto [first, last] = ends(branch);
    for (const Index n : {first, last}) {
      const auto incident = centerline().incident_segments(n);
      cones.insert(cones.end(), incident.begin(), incident.end());
    }
  }

  // What queries with these cones as hints need.
  FieldExcerpt around(std::vector<Index> cones) const {
    sort_unique(cones);
    return excerpts_.take(cones, kReach);
  }

  Branch as_in(const FieldExcerpt& field, Index branch) const {
    Branch result;
    for (const Index n : branches_.nodes(branch)) result.nodes.push_back(place_in(field.node, n));
    for (const Index s : branches_.segments(branch)) result.segments.push_back(place_in(field.cone, s));
    return result;
  }

  RingCounts::Ends ends(Index branch) const {
    return {branches_.nodes(branch).front(), branches_.nodes(branch).back()};
  }
  std::vector<RingCounts::Ends> all_ends() const {
    std::vector<RingCounts::Ends> all;
    all.reserve(size());
    for (Index b = 0; b < size(); ++b) all.push_back(ends(b));
    return all;
  }

  // The first branches of chunks of about kChunk segments, and the end.
  std::vector<Index> chunks() const {
    std::vector<Index> first = {0};
    std::size_t segments = 0;
    for (Index b = 0; b < branches_.size(); ++b) {
      segments += branches_.segments(b).size();
      if (segments < kChunk && b + 1 < branches_.size()) continue;
      first.push_back(b + 1);
      segments = 0;
    }
    return first;
  }

 private:
  const FieldExcerpts& excerpts_;
  BranchTable branches_;
};

// Lays the rings of the branches [first, end) and chooses their seams. Only counts and seams are kept, to save memory.
std::vector<RingPlace> scan(const WholeBranches& whole, const GenerateOptions& options, Index first, Index end,
                            std::vector<Index>& counts) {
  std::vector<Index> cones;
  for (Index b = first; b < end; ++b) whole.add_cones(b, cones);
  const FieldExcerpt excerpt = whole.around(std::move(cones));
  const Centerline centerline = excerpt.centerline();
  const VesselField field(centerline, excerpt);
  std::vector<Branch> branches;
  for (Index b = first; b < end; ++b) branches.push_back(whole.as_in(excerpt, b));
  const VesselAxes axes(field, RingOptions::of(options), std::move(branches));
  std::vector<RingPlace> seams;
  for (Index b = first; b < end; ++b) {
    const Rings laid = axes.layer().lay(b - first);
    counts[b] = static_cast<Index>(laid.rings.size());
    for (const RingPlace& seam : find_seams(axes, options, b - first, laid.rings)) seams.push_back({b, seam.ring});
  }
  return seams;
}

// The seams of all branches, chunk by chunk. Fills in how many rings lie along each.
std::vector<RingPlace> scan_all(const WholeBranches& whole, const GenerateOptions& options, std::vector<Index>& counts,
                                const Progress& progress) {
  counts.resize(whole.size());
  if (counts.empty()) return {};
  const std::vector<Index> first = whole.chunks();
  std::vector<std::vector<RingPlace>> found(first.size() - 1);
  std::atomic<std::size_t> done{0};
  tbb::parallel_for(
      std::size_t{0}, found.size(),
      [&](std::size_t i) {
        report_progress(progress, "divide", static_cast<double>(done) / static_cast<double>(found.size()));
        found[i] = scan(whole, options, first[i], first[i + 1], counts);
        ++done;
      },
      tbb::simple_partitioner());
  std::vector<RingPlace> seams;
  for (const auto& of_chunk : found) seams.insert(seams.end(), of_chunk.begin(), of_chunk.end());
  return seams;
}

class PartMaker {
 public:
  PartMaker(const WholeBranches& whole, const RingCounts& rings, const Division& division,
            const GenerateOptions& options)
      : whole_(whole), rings_(rings), division_(division), options_(options) {}

  // The first piece of every part, then the total: parts have about equally many rings.
  std::vector<Index> beginnings(std::size_t parts) const {
    std::vector<double> size = {0};  // cumulative, by piece
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
    part.field = whole_.around(cones_of(branches, first, end));
    for (const Index b : branches) part.branches.push_back(whole_.as_in(part.field, b));
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

  std::vector<Index> cones_of(const std::vector<Index>& branches, Index first, Index end) const {
    std::vector<Index> cones;
    for (const Index b : branches) whole_.add_cones(b, cones);
    for (Index p = first; p < end; ++p) {
      for (const Index n : division_.plans[p].nodes) {
        if (whole_.centerline().degree(n) == 0) cones.push_back(whole_.relations().sphere_of(n));
      }
    }
    return cones;
  }

  // Merges duplicates: a seam between two pieces of the part was added by both.
  static void merge(std::vector<SurfacePart::Seam>& seams) {
    std::sort(seams.begin(), seams.end(), [](const auto& a, const auto& b) { return a.place < b.place; });
    const auto same = [](const auto& a, const auto& b) { return a.place == b.place; };
    seams.erase(std::unique(seams.begin(), seams.end(), same), seams.end());
  }

  const WholeBranches& whole_;
  const RingCounts& rings_;
  const Division& division_;
  const GenerateOptions& options_;
};

// From numbers of the growth centerline to those of the one that was split.
void renumber(const GrowthCenterline& growth, SurfacePart& part) {
  for (Index& n : part.field.node) n = growth.node[n];
  for (Index& c : part.field.cone) c = growth.cone[c];
}

// Nothing is kept longer than it is needed: for ten million segments, every array counts.
SplitSummary split(Centerline given, const GenerateOptions& options, double vertices,
                   const std::function<void(SurfacePart)>& take, const Progress& progress) {
  SplitSummary summary;
  summary.options = options;
  std::optional<Centerline> centerline = std::move(given);
  summary.expected_vertices = expected_vertices(*centerline, options.around);
  std::optional<ConeRelations> relations(std::in_place, *centerline, options.blend);
  std::optional<GrowthCenterline> growth;
  if (std::vector<BuriedBranch> buried = find_buried_branches(*relations); !buried.empty()) {
    summary.simplifications = notes_of_buried(buried, *centerline);
    relations.reset();
    growth.emplace(without_buried_branches(*centerline, std::move(buried)));
    centerline.reset();
    release_freed_memory();
    relations.emplace(growth->centerline, options.blend);
  }
  release_freed_memory();
  summary.components = relations->centerline().component_count();
  summary.cycle_rank = relations->centerline().cycle_rank();

  const FieldExcerpts excerpts(*relations);
  const WholeBranches whole(excerpts);
  std::vector<Index> counts;
  std::vector<RingPlace> seams = scan_all(whole, options, counts, progress);
  release_freed_memory();
  const RingCounts rings(whole.centerline(), whole.all_ends(), std::move(counts));
  const Division division = divide(rings, std::move(seams));
  summary.pieces = division.plans.size();
  summary.seams = division.seams.size();
  const PartMaker maker(whole, rings, division, options);
  const double parts = std::clamp(std::round(summary.expected_vertices / vertices), 1.0, double(summary.pieces));
  const std::vector<Index> first = maker.beginnings(static_cast<std::size_t>(parts));
  summary.parts = first.size() - 1;
  for (std::size_t p = 0; p < summary.parts; ++p) {
    report_progress(progress, "split", static_cast<double>(p) / static_cast<double>(summary.parts));
    SurfacePart part = maker.make(first[p], first[p + 1]);
    if (growth) renumber(*growth, part);
    take(std::move(part));
  }
  return summary;
}

}  // namespace

SplitSummary split_surface(Centerline centerline, const GenerateOptions& given, double vertices,
                           const std::function<void(SurfacePart)>& take, const Progress& progress) {
  const GenerateOptions options = settled(given, centerline);
  check_parts_suffice(options);
  if (!(vertices >= 1)) throw InvalidInput("a part must have vertices");
  SplitSummary summary;
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  arena.execute([&] { summary = split(std::move(centerline), options, vertices, take, progress); });
  return summary;
}

}  // namespace vmesh

#include "vmesh/surface/generate.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <sstream>

#include <tbb/task_arena.h>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/defects.h"
#include "vmesh/surface/error_bound.h"

#include "surface/check/error_limit.h"
#include "surface/finish/optimize.h"
#include "surface/input/buried_branches.h"
#include "surface/input/size_check.h"
#include "surface/paper/paper_growth.h"
#include "surface/pieces/grow_pieces.h"
#include "surface/remesh/bound_surface.h"
#include "surface/remesh/mend.h"

namespace vmesh {
namespace {

class StageClock {
 public:
  explicit StageClock(std::vector<StageTime>& stages) : stages_(stages) {}

  template <class Work>
  void time(std::string stage, Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    stages_.push_back(
        {std::move(stage), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
  }

 private:
  std::vector<StageTime>& stages_;
};

using WarningKind = GrowthWarning::Kind;

void warn(GenerateResult& result, WarningKind kind, std::size_t count, const std::string& what) {
  if (count > 0) result.warnings.push_back({kind, count, what});
}

void add_warnings(const PaperGrowthReport& growth, GenerateResult& result) {
  warn(result, WarningKind::refused_faces, growth.refused,
       "growth: " + std::to_string(growth.refused) +
           " faces were crossed by the centerline behind its front, or too often, and left as they are; branching "
           "nodes crowd "
           "there, expect overlapping faces");
  warn(result, WarningKind::unclosed_loop, growth.unclosed,
       "growth: " + std::to_string(growth.unclosed) +
           " segments close a loop, which a single seed cannot do; the surface is open there");
  warn(result, WarningKind::forced_vertices, growth.forced,
       "growth: " + std::to_string(growth.forced) +
           " vertices did not reach the boundary by themselves and were projected");
}

void add_warnings(const OptimizeReport& optimized, GenerateResult& result) {
  warn(result, WarningKind::crossing_faces, optimized.tangles,
       "optimize: around " + std::to_string(optimized.tangles) +
           " vertices faces of neighbouring vessels intersect each other; more vertices around may help");
  warn(result, WarningKind::stopped_refining, optimized.limited,
       "optimize: refinement stopped early, the surface already has far more vertices than its length and radii ask "
       "for; expect folds");
}

// Whether pieces are grown even, and the whole surface is refined to the limit (grow_pieces()).
bool is_refined_as_a_whole(const GenerateOptions& options) {
  if (options.growth != GrowthMethod::guided) return false;
  const bool may_have_openings = options.open_ends.all || !options.open_ends.nodes.empty();
  return options.elongation <= 1 || (!options.deformable && (options.least_vertices > 0 || !may_have_openings));
}

// Where triangles are proven as they grow, single precision is too little.
VesselField& make_field(std::optional<VesselField>& field, const Centerline& centerline,
                        const GenerateOptions& options) {
  field.emplace(centerline, options.blend);
  if (options.max_error.is_set() && !is_refined_as_a_whole(options)) field->use_double_precision();
  return *field;
}

constexpr double kMendedAsPublished = 0.5;  // skewness above which triangles are mended: as in pieces

// With an error limit only those that are not sound: mending moves vertices off the boundary.
double mended_above(const GenerateOptions& options) {
  return options.max_error.is_set() ? kWorstSkewness : kMendedAsPublished;
}

// Ways to make a surface as published, the cheapest first.
struct PaperRung {
  double more_attraction;  // added to the weight of Eq. 11: fronts take other ways where branching nodes crowd
  bool guarded;            // growth and optimisation take guarded steps only: several times as long
};
// Measured on plausible random trees: of numbers 0 to 99, 77 are sound on the first without mending, 98 after the
// second, all after the third; 99 of another hundred after the last.
// Where more faces cross than this (at most 705 pairs on those trees), branching nodes crowd so that a single seed
// covers vessels twice all over, and each rung would take minutes; as it does on larger surfaces.
constexpr std::size_t kMostCrossings = 1000, kMostOnLadder = 20'000;  // the second: vertices
constexpr PaperRung kPaperLadder[] = {{0, false}, {0, true}, {0.1, true}, {-0.05, true}};

GenerateResult grow_paper(const Centerline& centerline, const GenerateOptions& options, const PaperRung& rung,
                          const Progress& progress) {
  GenerateResult result;
  StageClock clock(result.stages);
  std::optional<VesselField> field;
  clock.time("volume", [&] { make_field(field, centerline, options); });
  BoundSurface surface(*field);
  clock.time("grow", [&] {
    const double beta = std::clamp(options.beta + rung.more_attraction, 0.0, 1.0);
    add_warnings(grow_from_single_seeds(surface, beta, rung.guarded, progress), result);
  });
  clock.time("optimize", [&] {
    if (options.sweeps == 0) return;
    if (rung.guarded) surface.guard_crossings(BoundSurface::Axes::all);
    const GrownMesh grown{kGrownAround, expected_vertices(centerline, options.around), GrownMesh::Stage::grown};
    const OptimizeReport optimized = optimize(surface, options, grown, progress);
    add_warnings(optimized, result);
    if (rung.guarded || !optimized.crosses) mend_worst_faces(surface, mended_above(options), progress);
  });
  surface.export_to(result);
  clock.time("check", [&] {
    if (options.max_error.is_set()) {
      const std::vector<Index> unproven = unproven_faces(result.mesh, result.binding, *field, options.max_error);
      result.error = {unproven.size(), places_of(result.mesh, unproven), {}};
    }
    find_defects(centerline, self_intersections(result.mesh), result);
  });
  return result;
}

// A single seed cannot close loops: with these no rung helps.
GenerateResult generate_paper(const Centerline& centerline, const GenerateOptions& options, const Progress& progress) {
  std::optional<GenerateResult> best;
  for (const PaperRung& rung : kPaperLadder) {
    GenerateResult result = grow_paper(centerline, options, rung, progress);
    if (!best || result.defects.size() < best->defects.size()) best = std::move(result);
    if (best->is_sound() || options.sweeps == 0 || centerline.cycle_rank() > 0) break;
    if (best->check.crossing_pairs > kMostCrossings || best->mesh.vertices.size() > kMostOnLadder) break;
  }
  return *std::move(best);
}

void check_open_ends(const Centerline& centerline, const GenerateOptions& options) {
  const OpenEnds& ends = options.open_ends;
  if (!ends.all && ends.nodes.empty()) return;
  if (options.growth == GrowthMethod::paper) throw InvalidInput("open ends need guided growth");
  for (const Index n : ends.nodes) {
    if (n >= centerline.nodes().size() || centerline.degree(n) != 1)
      throw InvalidInput("node " + std::to_string(n) + " cannot be left open: it is not an end of the centerline");
  }
}

bool is_chosen(const OpenEnds& ends, Index node) {
  return ends.all || std::find(ends.nodes.begin(), ends.nodes.end(), node) != ends.nodes.end();
}

// For every node of the growth centerline, whether the surface is to be open there.
std::vector<char> nodes_to_open(const Centerline& centerline, const std::vector<Index>& number, const OpenEnds& ends) {
  std::vector<char> open(centerline.nodes().size(), 0);
  for (Index n = 0; n < open.size(); ++n) open[n] = centerline.degree(n) == 1 && is_chosen(ends, number[n]);
  return open;
}

void warn_of_closed_ends(const Centerline& centerline, const OpenEnds& ends, GenerateResult& result) {
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    if (centerline.degree(n) != 1 || !is_chosen(ends, n)) continue;
    if (std::any_of(result.openings.begin(), result.openings.end(), [&](const Opening& o) { return o.node == n; }))
      continue;
    std::ostringstream text;
    text << "open ends: the end at node " << n << " (" << centerline.node(n).position.transpose()
         << ") stays closed: other vessels cover its cross-section";
    warn(result, WarningKind::closed_end, 1, text.str());
  }
}

// From numbers of the growth centerline to those of the full one.
void renumber(const GrowthCenterline& growth, const Centerline& full, GenerateResult& result) {
  std::sort(result.openings.begin(), result.openings.end(),
            [](const Opening& a, const Opening& b) { return a.node < b.node; });
  for (Opening& opening : result.openings) {
    opening.node = growth.node[opening.node];
    opening.normal = normal_of(opening, result.mesh);
  }
  if (growth.buried.empty()) return;
  for (CenterlineBinding& binding : result.binding) binding.segment = growth.cone[binding.segment];
  for (GrowthSimplification& note : result.growth.simplifications) {
    for (Index& s : note.segments) s = growth.segment[s];
    for (Index& n : note.nodes) n = growth.node[n];
  }
  for (GrowthSimplification& note : notes_of_buried(growth.buried, full))
    result.growth.simplifications.push_back(std::move(note));
}

std::vector<std::pair<Index, Index>> grow_guided(const Centerline& centerline, const GenerateOptions& options,
                                                 const Progress& progress, StageClock& clock, GenerateResult& result) {
  std::optional<GrowthCenterline> growth;
  std::optional<VesselField> field;
  clock.time("volume", [&] {
    growth.emplace(without_buried_branches(make_field(field, centerline, options)));
    if (!growth->buried.empty()) make_field(field, growth->centerline, options);
  });
  const std::vector<char> open = nodes_to_open(growth->centerline, growth->node, options.open_ends);
  std::vector<std::pair<Index, Index>> crossings;
  clock.time("grow", [&] { crossings = grow_pieces(*field, open, options, progress, result); });
  renumber(*growth, centerline, result);
  return crossings;
}

// Grows the surface around the simplified centerline, if it is simpler.
GenerateResult generate_simplified(const Centerline& centerline, const GenerateOptions& options,
                                   const Progress& progress) {
  GenerateResult result;
  StageClock clock(result.stages);
  std::vector<std::pair<Index, Index>> crossings;
  std::optional<SimplifiedCenterline> simplified;
  if (options.simplification > 0)
    clock.time("simplify", [&] { simplified.emplace(simplify_for_growth(centerline, options)); });
  if (simplified && simplified->is_simpler()) {
    const GenerateOptions growth_options = after_simplification(options, *simplified);
    crossings = grow_guided(simplified->centerline, growth_options, progress, clock, result);
    refer_to_original(*simplified, result);
  } else {
    crossings = grow_guided(centerline, options, progress, clock, result);
  }
  release_freed_memory();  // the field's
  warn_of_closed_ends(centerline, options.open_ends, result);
  clock.time("check", [&] { find_defects(centerline, crossings, result); });
  return result;
}

// If the surface around the simplified centerline is not sound (a node that was left out may lie outside, say), it is
// grown around the full one.
GenerateResult generate_guided(const Centerline& centerline, const GenerateOptions& options, const Progress& progress) {
  GenerateResult result = generate_simplified(centerline, options, progress);
  if (result.is_sound() || result.simplification.nodes_left_out == 0) return result;
  GenerateOptions whole = options;
  whole.simplification = 0;
  return generate_simplified(centerline, whole, progress);
}

}  // namespace

Vec3 normal_of(const Opening& opening, const TriMesh& mesh) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t j = 0; j < opening.ring.size(); ++j) {
    const Vec3 a = mesh.vertices[opening.ring[j]] - opening.center;
    const Vec3 b = mesh.vertices[opening.ring[(j + 1) % opening.ring.size()]] - opening.center;
    normal += a.cross(b);
  }
  return normal.normalized();
}

TriMesh with_lids(const GenerateResult& result) {
  TriMesh mesh = result.mesh;
  for (const Opening& opening : result.openings) {
    const auto middle = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.push_back(opening.center);
    for (std::size_t j = 0; j < opening.ring.size(); ++j)
      mesh.faces.push_back({opening.ring[j], opening.ring[(j + 1) % opening.ring.size()], middle});
  }
  return mesh;
}

GenerateResult generate_surface(const Centerline& centerline, const GenerateOptions& given, const Progress& progress) {
  const GenerateOptions options = settled(given, centerline);
  require_memory_for(centerline, options);
  check_open_ends(centerline, options);
  GenerateResult result;
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    if (options.growth == GrowthMethod::paper) {
      result = generate_paper(centerline, options, progress);
    } else {
      result = generate_guided(centerline, options, progress);
    }
  });
  return result;
}

}  // namespace vmesh

#include "vmesh/fit/fit_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"
#include "vmesh/mesh/components.h"
#include "vmesh/mesh/topology.h"

#include "fit/correspondence.h"
#include "fit/farthest.h"
#include "fit/guarded_step.h"
#include "fit/least_squares.h"
#include "fit/reshaping.h"
#include "fit/resizing.h"
#include "fit/unmatched.h"
#include "surface/proof/defects.h"

namespace vmesh {
namespace {

constexpr double kLongestStep = 0.35;              // of the edges around
constexpr double kSamplesPerFace = 9;              // of the reference
constexpr int kDivision = 3, kCoarseDivision = 2;  // of the surface's faces: 9 or 4 samples
constexpr int kFewer = 2;                          // samples of the reference to one, where coarse will do
constexpr double kLeastMatched = 0.02;             // of the surface's area, for a reference that is somewhere else
constexpr int kRelaxations = 2;
constexpr int kRepairs = 4, kRepairPower = 8;  // of the triangles that a split or collapse left too skew
constexpr double kEvenShare = 0.5;             // of the error that 95 % keep to: what it is around most vertices
constexpr double kAim = 0.92;                  // of the error, while resizing: with few samples a little is missed
// RMS distances from which on a place, as a ridge that a triangle lies across, gets a vertex of its own. Measured on
// SU201, nine starts (growth with nodes left out at 0 to .8): Hausdorff .274 in the mean with 4 and 5, .288
// with 7; safe from 4 to 7.
constexpr double kFar = 5;
constexpr int kMostPlaces = 6;
constexpr int kFirstRounds = 3, kLastRounds = 4;
constexpr int kMoreRounds = 12;           // at most, to find the size for an error
constexpr double kOfMostVertices = 0.98;  // to aim at: the count is a matter of luck
constexpr int kCorrections = 5;
// Memory, measured.
constexpr double kBytesPerVertex = 12000, kBytesPerReferenceFace = 350;
constexpr double kCorrection = 0.93;  // of the even error, when 95 % do not keep to theirs

std::string text_of(const Vec3& p) {
  char text[128];
  std::snprintf(text, sizeof text, "(%.3f, %.3f, %.3f)", p.x(), p.y(), p.z());
  return text;
}

void check(const FitOptions& options) {
  if (options.rounds < 1 || options.rounds > 100) throw InvalidInput("rounds of a fit are 1 to 100");
  if (!(options.max_skewness >= 0.1 && options.max_skewness <= 0.9))
    throw InvalidInput("the skewness that a fit may come to is 0.1 to 0.9");
  if (!(options.error >= 0 && std::isfinite(options.error)))
    throw InvalidInput("the error of a fit is 0 or more, and finite");
}

void check(const VesselSurface& surface, const VesselField& field) {
  if (surface.mesh.faces.empty()) throw InvalidInput("the surface to fit has no faces");
  if (surface.binding.size() != surface.mesh.vertices.size())
    throw InvalidInput("the surface has " + std::to_string(surface.mesh.vertices.size()) + " vertices, but " +
                       std::to_string(surface.binding.size()) + " of them are bound to the centerline");
  for (std::size_t v = 0; v < surface.binding.size(); ++v) {
    if (surface.binding[v].segment >= field.cone_count())
      throw InvalidInput("vertex " + std::to_string(v) + " is bound to segment " +
                         std::to_string(surface.binding[v].segment) + ", which the centerline does not have");
  }
  const Topology topology = measure_topology(surface.mesh);
  if (!topology.manifold || !topology.oriented)
    throw InvalidInput("the surface to fit is not manifold and oriented; vmesh evaluate tells where");
  const auto crossing = self_intersections(surface.mesh);
  if (!crossing.empty()) {
    const Index v = surface.mesh.faces[crossing.front().first][0];
    throw InvalidInput("the surface to fit has " + std::to_string(crossing.size()) +
                       " pairs of faces that cross, the first at " + text_of(surface.mesh.vertices[v]) +
                       "; make one without (--overlap separate)");
  }
}

/// Memory that a fit of so many vertices takes, at most, with the reference.
void check_memory(std::size_t vertices, const TriMesh& reference) {
  require_memory(
      kBytesPerVertex * static_cast<double>(vertices) +
          kBytesPerReferenceFace * static_cast<double>(reference.faces.size()),
      "a fit of " + std::to_string(vertices) + " vertices to " + std::to_string(reference.faces.size()) + " faces",
      "allow fewer vertices or a larger error, or make the reference coarser");
}

double worst_skewness(const FitMesh& surface) {
  double worst = 0;
  for (Index f = 0; f < surface.faces.size(); ++f) worst = std::max(worst, skewness_of(surface, f));
  return worst;
}

class Fit {
 public:
  Fit(const VesselSurface& surface, const VesselField& field, const TriMesh& reference, const FitOptions& options)
      : field_(field),
        options_(options),
        to_error_(options.error > 0),
        reference_(reference, field),
        surface_(surface.mesh, vertices_of(surface)),
        openings_(surface.openings.empty() ? find_openings(surface.mesh) : surface.openings) {
    guard_.max_skewness = options.max_skewness;
    if (options.error > 0) limits_.step = 1.4;
    const double count = kSamplesPerFace * static_cast<double>(surface_.faces.size());
    samples_ = reference_.samples(field, static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < samples_.size(); i += kFewer) {
      few_samples_.push_back(samples_[i]);
      few_samples_.back().area *= kFewer;
    }
    samples_and_rims_ = samples_;
    for (const ReferenceSample& sample : reference_.rim_samples()) samples_and_rims_.push_back(sample);
    most_vertices_ = options.max_vertices;
    if (most_vertices_ == 0) most_vertices_ = surface.mesh.vertices.size() * 21 / 20;
    wanted_vertices_ = static_cast<std::size_t>(kOfMostVertices * static_cast<double>(most_vertices_));
    const double refinement =
        options.error > 0
            ? 8
            : std::sqrt(static_cast<double>(wanted_vertices_) / static_cast<double>(surface_.vertices.size()));
    limits_.finest = std::min(limits_.finest, 0.5 / refinement);
    limits_.coarsest = std::max(limits_.coarsest, options.error > 0 ? 4 : 1.5 / refinement);
    for (Index i = 0; i < openings_.size(); ++i) {
      opening_normals_.push_back(openings_[i].normal.normalized());
      for (const Index v : openings_[i].ring) surface_.vertices[v].opening = i;
    }
    for (Index v = 0; v < surface_.vertices.size(); ++v) surface_.vertices[v].base_size = surface_.mean_edge(v);
  }

  const FitReference& reference() const { return reference_; }
  const FitMesh& surface() const { return surface_; }
  int rounds() const { return rounds_; }

  TriMesh reference_without_apart(FitReport& report) const {
    const std::vector<char> apart =
        faces_apart(find_matches(surface_, reference_, samples_, field_, kCoarseDivision), samples_, reference_);
    TriMesh rest{reference_.mesh().vertices, {}}, others = rest;
    for (Index f = 0; f < apart.size(); ++f) (apart[f] ? others : rest).faces.push_back(reference_.mesh().faces[f]);
    report.parts_apart = split_components(others).size();
    report.area_apart = surface_area(others);
    return rest.faces.empty() ? reference_.mesh() : rest;
  }

  void run(const Progress& progress) {
    progress_ = &progress;
    for (int i = 0; i < kFirstRounds; ++i) {
      const Matches matches = next_matches(true);
      if (i == 0) check_matched(matches);
      step(matches);
      reshape(1, true);
    }
    if (options_.resize) resize();
    if (options_.resize && !to_error_) keep_to_most_vertices();
    finish();
    for (int i = 0; options_.resize && to_error_ && i < kCorrections && !keeps_error(); ++i) {
      even_error_ *= kCorrection;
      for (int round = 0; round < 2; ++round) resize_once(next_matches());
      if (!to_error_) keep_to_most_vertices();
      finish();
    }
  }

  FitResult result() {
    FitResult result;
    for (const FitMesh::Vertex& v : surface_.vertices) {
      const FieldSample sample = field_.sample(v.position, v.cone);
      result.surface.binding.push_back({sample.cone, sample.t});
      result.radius.push_back(field_.radius_at(sample.cone, sample.t));
    }
    result.surface.mesh = surface_.tri_mesh();
    result.surface.openings = openings_;
    return result;
  }

 private:
  static std::vector<FitMesh::Vertex> vertices_of(const VesselSurface& surface) {
    std::vector<FitMesh::Vertex> vertices;
    for (std::size_t v = 0; v < surface.mesh.vertices.size(); ++v)
      vertices.push_back({surface.mesh.vertices[v], surface.binding[v].segment, kNone, 0, 0});
    return vertices;
  }

  void check_matched(const Matches& matches) const {
    double all = 0, matched = 0;
    for (const Match& match : matches.from_surface) {
      all += 1;
      if (match.face != kNone) matched += 1;
    }
    if (matched < kLeastMatched * all)
      throw InvalidInput("the reference is nowhere near the surface; do both have the same unit and frame?");
  }

  Matches next_matches(bool coarse = false) {
    ++rounds_;
    const double share = static_cast<double>(rounds_) / (rounds_ + kFirstRounds);  // not known beforehand
    report_progress(*progress_, "fit", share);
    return matches_now(coarse);
  }

  Matches matches_now(bool coarse) const {
    if (coarse) return find_matches(surface_, reference_, few_samples_, field_, kCoarseDivision);
    return find_matches(surface_, reference_, samples_, field_, kDivision);
  }

  Matches matches_at_rims() const { return find_matches(surface_, reference_, samples_and_rims_, field_, kDivision); }

  // The last rounds: shape gives way to nearness.
  void finish() {
    for (int i = 0; i < kLastRounds; ++i) {
      step(next_matches());
      if (i < kLastRounds - 2) reshape(2, false);
    }
    if (options_.resize) put_vertices_where_farthest();
  }

  void put_vertices_where_farthest() {
    std::vector<Place> left_alone;
    for (int i = 0; i < kMostPlaces && surface_.vertices.size() < most_vertices_; ++i) {
      const Matches matches = matches_at_rims();
      const Match worst = farthest_match(surface_, matches, left_alone);
      if (std::abs(worst.distance) <= kFar * rms_distance(matches)) return;
      const Place place = place_of(surface_, worst);
      if (!put_vertex_at(worst, left_alone)) left_alone.push_back(place);
    }
  }

  // Returns whether what is farthest came nearer by it.
  bool put_vertex_at(const Match& worst, const std::vector<Place>& left_alone) {
    double least = std::abs(worst.distance);
    if (least > kNotOfSize * surface_.mean_edge(surface_.faces[worst.face][0])) return false;
    const auto before = std::pair(surface_, openings_);
    auto best = before;
    const double limit = std::max(guard_.max_skewness, worst_skewness(surface_));
    for (int side = 0; side < 3; ++side) {
      std::tie(surface_, openings_) = before;
      put_vertex(worst, side);
      const double left = std::abs(farthest_match(surface_, matches_at_rims(), left_alone).distance);
      if (left >= least || worst_skewness(surface_) > limit) continue;
      least = left;
      best = {surface_, openings_};
    }
    std::tie(surface_, openings_) = best;
    return least < std::abs(worst.distance);
  }

  void put_vertex(const Match& match, int side) {
    change_safely(surface_, [&](FitMesh& surface, const std::vector<char>& frozen) {
      split_at(surface, match, side);
      flip_closer(surface, frozen, false);
      repair(surface, frozen);
    });
    pack();
    find_cones();
    for (int i = 0; i < 2; ++i) step(matches_now(true));
  }

  bool keeps_error() const {
    const TriMesh mesh = surface_.tri_mesh();
    return sample_distance(mesh, reference_.index(), options_.samples).distance.p95 <= options_.error &&
           sample_distance(reference_.mesh(), ClosestPointIndex(mesh), options_.samples).distance.p95 <= options_.error;
  }

  void step(const Matches& matches) {
    std::vector<Vec3> steps = least_squares_steps(surface_, matches, shape_steps(surface_, 2), opening_normals_, {});
    for (Index v = 0; v < steps.size(); ++v) {
      const double longest = kLongestStep * surface_.mean_edge(v), norm = steps[v].norm();
      if (norm > longest) steps[v] *= longest / norm;
    }
    take_steps(surface_, steps, guard_);
    find_cones();
  }

  void find_cones() {
    tbb::parallel_for(std::size_t{0}, surface_.vertices.size(), [&](std::size_t v) {
      surface_.vertices[v].cone = field_.sample(surface_.vertices[v].position, surface_.vertices[v].cone).cone;
    });
  }

  // How far a point on an edge is from the reference.
  double distance_at(const FitMesh& surface, Index a, Index b, const Vec3& p) const {
    const Index cone = surface.vertices[a].cone;
    const Vec3 normal = surface.vertex_normal(a) + surface.vertex_normal(b);
    const auto accepts = [&](Index g) {
      return reference_.normal(g).dot(normal) > 0 && same_vessel(field_, cone, reference_.cone(g));
    };
    const auto found = reference_.index().closest_among(p, 1.5 * widest_radius(field_, cone), accepts);
    return found ? found->distance : -1;
  }

  void flip_closer(FitMesh& surface, const std::vector<char>& frozen, bool harsh) const {
    flip_edges_closer(surface, frozen, harsh,
                      [&](Index a, Index b, const Vec3& p) { return distance_at(surface, a, b, p); });
  }

  // `first`: there are rounds left to repair what flips make skew.
  void reshape(int power, bool first) {
    change_safely(surface_, [&](FitMesh& surface, const std::vector<char>& frozen) {
      if (options_.resize) flip_closer(surface, frozen, first);
      if (options_.resize && first) flip_edges(surface, frozen, guard_);
      for (int i = 0; i < kRelaxations; ++i) relax(surface, frozen, guard_, power);
      repair(surface, frozen);
    });
  }

  void repair(FitMesh& surface, const std::vector<char>& frozen) const {
    for (int i = 0; i < kRepairs; ++i) relax(surface, frozen, guard_, kRepairPower, guard_.max_skewness);
  }

  // For an error, until the number of vertices has settled.
  void resize() {
    const int rounds = std::max(1, options_.rounds - kFirstRounds - kLastRounds);
    for (int i = 0; i < (to_error_ ? rounds + kMoreRounds : rounds); ++i) {
      const Matches matches = next_matches();
      const std::size_t before = surface_.vertices.size();
      const double p95 = to_error_ ? matched_distance(matches, 0.95) : 0;
      if (to_error_ && settled_ && i >= rounds && p95 <= 0.95 * options_.error && p95 > 0.88 * options_.error) return;
      if (to_error_) aim_at_error(p95);
      resize_once(matches);
      const double change = static_cast<double>(surface_.vertices.size()) / static_cast<double>(before);
      settled_ = change > 0.95 && change < 1.05;
    }
  }

  void keep_to_most_vertices() {
    for (int i = 0; i < kCorrections && surface_.vertices.size() > most_vertices_; ++i) {
      aim_ *= kCorrection;
      resize_once(next_matches());
    }
  }

  void resize_once(const Matches& matches) {
    const double wanted = aim_ * static_cast<double>(wanted_vertices_);
    const double faces = set_sizes(surface_, errors_around(surface_, matches),
                                   to_error_ ? 0 : static_cast<std::size_t>(wanted), even_error_, limits_);
    check_memory(static_cast<std::size_t>(faces / 2), reference_.mesh());
    change_safely(surface_, [&](FitMesh& surface, const std::vector<char>& frozen) {
      split_edges(surface, frozen);
      flip_edges(surface, frozen, guard_);
      collapse_edges(surface, frozen, guard_);
      for (int i = 0; i < 2; ++i) {
        flip_edges(surface, frozen, guard_);
        for (int k = 0; k < kRelaxations; ++k) relax(surface, frozen, guard_, 1);
      }
      repair(surface, frozen);
    });
    pack();
    if (options_.max_vertices > 0 && surface_.vertices.size() > most_vertices_) to_error_ = false;
    // What the edges' lengths come to differs a little from what they are meant to be.
    aim_ = std::clamp(
        aim_ * std::pow(static_cast<double>(wanted_vertices_) / static_cast<double>(surface_.vertices.size()), 0.7),
        0.8, 1.25);
    find_cones();
    step(matches_now(true));
    change_safely(surface_,
                  [&](FitMesh& surface, const std::vector<char>& frozen) { flip_closer(surface, frozen, false); });
    step(matches_now(false));
  }

  // What the error around vertices should be for 95 % of the distances to be below options.error.
  void aim_at_error(double p95) {
    if (even_error_ == 0) even_error_ = kEvenShare * options_.error;
    if (settled_ && p95 > 0) even_error_ *= std::clamp(std::sqrt(kAim * options_.error / p95), 0.8, 1.25);
  }

  void pack() {
    const std::vector<Index> number = surface_.pack();
    for (Opening& opening : openings_) {
      for (Index& v : opening.ring) v = number[v];
    }
  }

  const VesselField& field_;
  const FitOptions& options_;
  bool to_error_;  // sizes are those for an error; or for a number of vertices, without one or where that is exceeded
  FitReference reference_;
  FitMesh surface_;
  std::vector<Opening> openings_;
  std::vector<Vec3> opening_normals_;
  std::vector<ReferenceSample> samples_, few_samples_, samples_and_rims_;
  std::size_t most_vertices_ = 0, wanted_vertices_ = 0;
  double even_error_ = 0;  // mm, to have everywhere
  bool settled_ = false;   // the number of vertices
  int rounds_ = 0;
  const Progress* progress_ = nullptr;
  double aim_ = 1;  // vertices to ask for, to get as many as wanted
  StepGuard guard_;
  SizeLimits limits_;
};

FitDistance distance_between(const TriMesh& surface, const TriMesh& reference, const FitOptions& options) {
  HausdorffOptions hausdorff_options;
  hausdorff_options.tolerance = options.tolerance;
  return {hausdorff(surface, reference, hausdorff_options),
          sample_distance(surface, ClosestPointIndex(reference), options.samples),
          sample_distance(reference, ClosestPointIndex(surface), options.samples)};
}

}  // namespace

std::vector<Opening> find_openings(const TriMesh& mesh) {
  std::vector<Index> next(mesh.vertices.size(), kNone);  // along the border, as a lid would run
  for (const auto& [from, to] : boundary_edges(mesh)) next[to] = from;
  std::vector<Opening> openings;
  for (Index first = 0; first < next.size(); ++first) {
    if (next[first] == kNone) continue;
    Opening opening;
    for (Index v = first; next[v] != kNone;) {
      opening.ring.push_back(v);
      v = std::exchange(next[v], kNone);
    }
    for (const Index v : opening.ring) opening.center += mesh.vertices[v] / static_cast<double>(opening.ring.size());
    for (std::size_t i = 0; i < opening.ring.size(); ++i) {
      const Vec3 a = mesh.vertices[opening.ring[i]] - opening.center;
      const Vec3 b = mesh.vertices[opening.ring[(i + 1) % opening.ring.size()]] - opening.center;
      opening.normal += a.cross(b);
    }
    opening.normal.normalize();
    openings.push_back(std::move(opening));
  }
  return openings;
}

FitResult fit_surface(const VesselSurface& surface, const Centerline& centerline, const TriMesh& reference,
                      const FitOptions& options, const Progress& progress) {
  check(options);
  const VesselField field(centerline);
  check(surface, field);
  const std::size_t aimed_at = options.error > 0 ? 0 : options.max_vertices;  // else a limit
  check_memory(std::max(surface.mesh.vertices.size(), aimed_at), reference);
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  return arena.execute([&] {
    Fit fit(surface, field, reference, options);
    fit.run(progress);
    FitResult result = fit.result();
    FitReport& report = result.report;
    report.vertices_before = surface.mesh.vertices.size();
    report.turned = fit.reference().turned();
    report.rounds = fit.rounds();
    const TriMesh compared = fit.reference_without_apart(report);
    report.before = distance_between(surface.mesh, compared, options);
    report.after = distance_between(result.surface.mesh, compared, options);
    report.uncovered = uncovered_parts(fit.surface(), fit.reference(), field);
    report.unsupported = unsupported_parts(fit.surface(), fit.reference(), field);
    return result;
  });
}

FitReport fit_surface(GenerateResult& result, const Centerline& centerline, const TriMesh& reference,
                      const FitOptions& options, const Progress& progress) {
  FitResult fitted = fit_surface(VesselSurface{result.mesh, result.binding, result.openings}, centerline, reference,
                                 options, progress);
  result.mesh = std::move(fitted.surface.mesh);
  result.binding = std::move(fitted.surface.binding);
  result.openings = std::move(fitted.surface.openings);
  result.radius = std::move(fitted.radius);
  result.defects.clear();
  find_defects(centerline, self_intersections(result.mesh), result);
  std::erase_if(result.defects, [&](const Defect& defect) {
    if (defect.kind != DefectKind::node_outside) return false;
    fitted.report.nodes_outside.push_back(defect);
    return true;
  });
  return std::move(fitted.report);
}

}  // namespace vmesh

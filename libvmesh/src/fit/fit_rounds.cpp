#include "fit/fit_rounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"
#include "vmesh/mesh/components.h"
#include "vmesh/mesh/topology.h"

#include "fit/buried.h"
#include "fit/farthest.h"
#include "fit/long_triangles.h"
#include "fit/reshaping.h"
#include "fit/spikes.h"
#include "fit/subdivision.h"
#include "fit/unmatched.h"

namespace vmesh::fitting {
namespace {

constexpr double kSamplesPerFace = 9;              // of the reference
constexpr int kDivision = 3, kCoarseDivision = 2;  // of the surface's faces: 9 or 4 samples
constexpr int kFewer = 3;               // one in this number of samples of the reference where a coarse fit is enough
constexpr double kLeastMatched = 0.02;  // of the surface's area: with less, the reference is somewhere else
constexpr int kRelaxations = 2;
// In the last rounds only triangles that are skewer are relaxed: in the tangent plane vertices leave the reference.
constexpr double kLeftSkewness = 0.2;
constexpr double kEvenShare = 0.5;  // of the error kept by 95 %: the error around most vertices
constexpr double kAim = 0.92;       // of the error, while resizing: few samples underestimate it
constexpr int kFirstRounds = 3, kLastRounds = 3;
constexpr int kMoreRounds = 12;           // at most, to find the size that gives an error
constexpr double kOfMostVertices = 0.98;  // target: the exact count cannot be controlled
constexpr double kMore = 1.05;            // vertices that a fit may add without a budget
constexpr int kCorrections = 5, kErrorCorrections = 8;
// SizeLimits. For an error the count is not known beforehand: sizes may change by more, and by more at once.
constexpr double kFinest = 0.5, kCoarsest = 1.5;  // without an error, relative to sizes for the count wanted
constexpr double kErrorStep = 1.4, kErrorRefinement = 8, kErrorCoarsest = 4;
// Long triangles: the even fit from which they are made has this multiple of their number (measured on three fits: 6: 3
// % farther, 4: 7), in the end halved this often; more vertices than twice the reference's add nothing.
constexpr double kDense = 8, kDenseReference = 2;
constexpr int kSubdivisions = 2, kDenseSteps = 2;
// With an error: the even fit has it before it is halved, once.
constexpr double kLongShare = 0.4;  // of its vertices: the first number to be tried
constexpr int kLongCorrections = 6;
constexpr double kLongError = 0.97;  // of the error: aim of the corrections
// The error is kept where 95 % of the distances are between these shares of it.
constexpr double kNearlyError = 0.88, kKeptError = 0.95;
constexpr double kSettled = 0.05;  // change of the number of vertices in a round, below which it has settled
constexpr double kAimPower = 0.7, kAimStep = 1.25;  // how strongly and how far the aim follows what came out
// Memory, measured.
constexpr double kBytesPerVertex = 12000, kBytesPerReferenceFace = 350;
// Of the largest error allowed: the one that 95 % are to keep, in the first try; the one at which places get vertices
// of their own.
constexpr double kOfMaxError = 0.4, kSafelyBelow = 0.85;
constexpr int kMaxErrorCorrections = 5;
constexpr double kMaxErrorProgress = 0.8;     // a correction that leaves more of the area beyond it was in vain
constexpr double kMaxErrorCorrection = 0.75;  // factor on the even error, or that of 95 %, where that did not do
constexpr double kCorrection = 0.93;          // factor on the even error when the 95 % miss theirs

}  // namespace

void check_memory(std::size_t vertices, const TriMesh& reference) {
  require_memory(
      kBytesPerVertex * static_cast<double>(vertices) +
          kBytesPerReferenceFace * static_cast<double>(reference.faces.size()),
      "a fit of " + std::to_string(vertices) + " vertices to " + std::to_string(reference.faces.size()) + " faces",
      "allow fewer vertices or a larger error, or make the reference coarser");
}

std::vector<FitVertex> vertices_of(const VesselSurface& surface) {
  std::vector<FitVertex> vertices;
  for (std::size_t v = 0; v < surface.mesh.vertices.size(); ++v)
    vertices.push_back({surface.mesh.vertices[v], surface.binding[v].segment});
  return vertices;
}

Fit::Fit(const VesselSurface& surface, const VesselField& field, const TriMesh& reference, const FitOptions& options)
    : field_(field),
      options_(options),
      error_(wanted_error(options)),
      to_error_(error_ > 0),
      reference_(reference, field),
      setting_{reference_, field, {}, {}},
      surface_(surface.mesh.faces, vertices_of(surface)),
      openings_(surface.openings.empty() ? find_openings(surface.mesh) : surface.openings) {
  setting_.guard.max_skewness = options.max_skewness;
  if (error_ > 0) limits_.step = kErrorStep;
  most_vertices_ = options.max_vertices;
  if (most_vertices_ == 0)
    most_vertices_ = static_cast<std::size_t>(kMore * static_cast<double>(surface.mesh.vertices.size()));
  long_vertices_ = most_vertices_;  // that count is met exactly
  const double more = static_cast<double>(options.max_vertices) / static_cast<double>(surface.mesh.vertices.size());
  const double count =
      kSamplesPerFace * (to_error_ ? 1 : std::max(1.0, more)) * static_cast<double>(surface_.faces().size());
  samples_ = reference_.samples(field, static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < samples_.size(); i += kFewer) {
    few_samples_.push_back(samples_[i]);
    few_samples_.back().area *= kFewer;
  }
  samples_and_rims_ = samples_;
  for (const ReferenceSample& sample : reference_.rim_samples()) samples_and_rims_.push_back(sample);
  if (is_long() && !to_error_) most_vertices_ = vertices_before_subdivision();
  wanted_vertices_ = static_cast<std::size_t>(kOfMostVertices * static_cast<double>(most_vertices_));
  const double refinement =
      error_ > 0 ? kErrorRefinement
                 : std::sqrt(static_cast<double>(wanted_vertices_) / static_cast<double>(surface_.vertices().size()));
  limits_.finest = std::min(limits_.finest, kFinest / refinement);
  limits_.coarsest = std::max(limits_.coarsest, error_ > 0 ? kErrorCoarsest : kCoarsest / refinement);
  for (Index i = 0; i < openings_.size(); ++i) {
    setting_.opening_normals.push_back(openings_[i].normal.normalized());
    for (const Index v : openings_[i].ring) surface_.edit(v).opening = i;
  }
  for (Index v = 0; v < surface_.vertices().size(); ++v) surface_.edit(v).base_size = surface_.mean_edge(v);
}

TriMesh Fit::reference_without_apart(FitReport& report) const {
  const std::vector<char> apart =
      faces_apart(find_matches(surface_, reference_, samples_, field_, {kCoarseDivision}), samples_, reference_);
  TriMesh rest{reference_.mesh().vertices, {}}, others = rest;
  for (Index f = 0; f < apart.size(); ++f) (apart[f] ? others : rest).faces.push_back(reference_.mesh().faces[f]);
  report.parts_apart = split_components(others).size();
  report.area_apart = surface_area(others);
  return rest.faces.empty() ? reference_.mesh() : rest;
}

void Fit::run(const Progress& progress) {
  progress_ = &progress;
  for (int i = 0; i < kFirstRounds; ++i) {
    const Matches matches = next_matches(true);
    if (i == 0) check_matched(matches);
    step(matches);
    reshape(1, true);
  }
  if (options_.resize) resize();
  if (options_.resize && !to_error_) keep_to_wanted_vertices();
  if (is_long()) return to_error_ ? make_long_to_error() : make_long();
  finish();
  for (int i = 0; options_.resize && to_error_ && i < kErrorCorrections && !keeps_error(); ++i) correct(kCorrection);
  if (options_.max_error > 0) reach_max_error();
}

FitResult Fit::result() {
  FitResult result;
  for (const FitVertex& v : surface_.vertices()) {
    const FieldSample sample = field_.sample(v.position, v.cone);
    result.surface.binding.push_back({sample.cone, sample.t});
    result.radius.push_back(field_.relations().radius_at(sample.cone, sample.t));
    if (is_long()) result.elongation.push_back(v.elongation);
  }
  result.surface.mesh = surface_.tri_mesh();
  result.surface.openings = openings_;
  return result;
}

double Fit::wanted_error(const FitOptions& options) {
  if (options.max_error == 0) return options.error;
  const double share = kOfMaxError * options.max_error;
  return options.error > 0 ? std::min(options.error, share) : share;
}

void Fit::check_matched(const Matches& matches) const {
  double all = 0, matched = 0;
  for (const Match& match : matches.from_surface) {
    all += 1;
    if (match.face != kNone) matched += 1;
  }
  if (matched < kLeastMatched * all)
    throw InvalidInput("the reference is nowhere near the surface; do both have the same unit and frame?");
}

void Fit::report_round() {
  ++rounds_;
  const double share = static_cast<double>(rounds_) /
                       (rounds_ + kFirstRounds);  // an estimate: the number of rounds is not known beforehand
  report_progress(*progress_, "fit", share);
}

Matches Fit::next_matches(bool coarse) {
  report_round();
  return matches_now(coarse);
}

Matches Fit::matches_after_step() {
  Matches matches = next_matches(!to_error_);
  const std::vector<FitVertex> before = surface_.vertices();
  step(matches);
  follow(matches, before, surface_);
  return matches;
}

bool Fit::remove_buried(const Matches& matches) {
  if (!options_.resize || remove_buried_walls(surface_, matches, setting_) == 0) return false;
  pack(surface_, openings_);
  return true;
}

Matches Fit::matches_now(bool coarse) {
  Matches matches = find_matches(surface_, reference_, coarse ? few_samples_ : samples_, field_,
                                 {coarse ? kCoarseDivision : kDivision});
  remember(surface_, matches);
  return matches;
}

void Fit::finish() {
  for (int i = 0; i < kLastRounds; ++i) {
    const bool last = i >= kLastRounds - 2;
    step(next_matches(!last && !to_error_));
    if (!last) reshape(2, false);
  }
  if (options_.resize) bring_farthest_nearer(surface_, samples_and_rims_, setting_, most_vertices_);
}

std::size_t Fit::vertices_before_subdivision() const {
  const double wanted = static_cast<double>(long_vertices_);
  const double most = std::max(2 * wanted, kDenseReference * static_cast<double>(reference_.mesh().vertices.size()));
  return static_cast<std::size_t>(std::min(kDense * wanted, most) / std::pow(4, kSubdivisions));
}

void Fit::make_long() {
  check_memory(surface_.vertices().size() * (std::size_t{1} << (2 * kSubdivisions)), reference_.mesh());
  make_dense(kSubdivisions);
  make_long(long_vertices_);
}

void Fit::make_long_to_error() {
  const double even = static_cast<double>(surface_.vertices().size());
  check_memory(4 * surface_.vertices().size(), reference_.mesh());
  make_dense(1);
  const FitMesh dense = surface_;
  const std::vector<Opening> openings = openings_;
  const double most = options_.max_vertices > 0 ? static_cast<double>(options_.max_vertices) : 2 * even;
  double vertices = std::min(kLongShare * even, most);
  const auto make = [&] {
    surface_ = dense;
    openings_ = openings;
    make_long(static_cast<std::size_t>(vertices));
  };
  for (int i = 0; i < kLongCorrections; ++i) {
    make();
    const double error = p95(), share = error / error_;
    if ((share <= 1 && share > kKeptError) || (share > 1 && vertices >= most)) break;
    vertices = std::min(most, vertices * share / kLongError);
  }
  if (options_.max_error == 0) return;
  mend_beyond([&] {
    if (vertices >= most) return false;
    vertices = std::min(most, vertices / kMaxErrorCorrection);
    make();
    return true;
  });
}

void Fit::make_dense(int subdivisions) {
  for (int i = 0; i < subdivisions; ++i) {
    subdivide(surface_);
    step(next_matches());
    reshape(2, false);
  }
  for (int i = 0; i < kDenseSteps; ++i) {
    Matches matches = next_matches();
    if (remove_buried(matches)) matches = next_matches();
    step(matches);
  }
}

void Fit::make_long(std::size_t vertices) {
  const auto round = [this] { report_round(); };
  LongTriangles(surface_, openings_, setting_, samples_, round)
      .make(vertices, options_.elongation, options_.deformable);
}

double Fit::p95() const {
  const TriMesh mesh = surface_.tri_mesh();
  return std::max(sample_distance(mesh, reference_.index(), options_.samples).distance.p95,
                  sample_distance(reference_.mesh(), ClosestPointIndex(mesh), options_.samples).distance.p95);
}

double Fit::area_beyond() const {
  FitReport report;
  find_far(report, surface_, reference_, field_, options_.max_error);
  double area = 0;
  for (const UnmatchedPart& part : report.beyond) area += part.area;
  return area;
}

void Fit::correct(double factor) {
  even_error_ *= factor;
  for (int round = 0; round < 2; ++round) resize_once(matches_after_step());
  if (!to_error_) keep_to_wanted_vertices();
  finish();
}

void Fit::reach_max_error() {
  const std::size_t most = options_.max_vertices > 0 ? most_vertices_ : std::numeric_limits<std::size_t>::max();
  const auto bring = [&] {
    bring_below(surface_, samples_and_rims_, setting_, most, kSafelyBelow * options_.max_error);
  };
  bring();
  mend_beyond([&] {
    if (!to_error_) return false;
    correct(kMaxErrorCorrection);
    bring();
    return true;
  });
}

template <class Correct>
void Fit::mend_beyond(Correct&& correct) {
  double left = area_beyond();
  for (int i = 0; i < kMaxErrorCorrections && left > 0; ++i) {
    const FitMesh surface = surface_;
    const std::vector<Opening> openings = openings_;
    if (!correct()) return;
    const double area = area_beyond();
    if (area > kMaxErrorProgress * left) {
      surface_ = surface;
      openings_ = openings;
      return;
    }
    left = area;
  }
}

void Fit::reshape(int power, bool first) {
  change_safely(surface_, [&](FitMesh& surface, const std::vector<char>& frozen) {
    if (options_.resize) {
      collapse_spikes(surface, frozen, setting_);
      flip_closer(surface, frozen, first, setting_);
      if (first) flip_edges(surface, frozen, setting_.guard);
    }
    for (int i = 0; i < kRelaxations; ++i) relax(surface, frozen, setting_.guard, power, first ? 0 : kLeftSkewness);
    repair(surface, frozen, setting_.guard);
  });
  if (surface_.vertex_count() < surface_.vertices().size()) pack(surface_, openings_);
}

void Fit::resize() {
  const int rounds = std::max(1, options_.rounds - kFirstRounds - kLastRounds);
  for (int i = 0; i < (to_error_ ? rounds + kMoreRounds : rounds); ++i) {
    Matches matches = matches_after_step();
    if (remove_buried(matches)) matches = matches_after_step();
    const std::size_t before = surface_.vertices().size();
    const double p95 = to_error_ ? matched_distance(matches, 0.95) : 0;
    if (to_error_ && settled_ && i >= rounds && p95 <= kKeptError * error_ && p95 > kNearlyError * error_) return;
    if (to_error_) aim_at_error(p95);
    resize_once(matches);
    const double change = static_cast<double>(surface_.vertices().size()) / static_cast<double>(before);
    settled_ = std::abs(change - 1) < kSettled;
  }
}

void Fit::keep_to_wanted_vertices() {
  for (int i = 0; i < kCorrections && surface_.vertices().size() > wanted_vertices_; ++i) {
    aim_ *= kCorrection;
    resize_once(matches_after_step());
  }
}

void Fit::resize_once(const Matches& matches) {
  const double wanted = aim_ * static_cast<double>(wanted_vertices_);
  const double faces = set_sizes(surface_, errors_around(surface_, matches),
                                 to_error_ ? 0 : static_cast<std::size_t>(wanted), even_error_, limits_);
  check_memory(static_cast<std::size_t>(faces / 2), reference_.mesh());
  change_safely(surface_, [&](FitMesh& surface, const std::vector<char>& frozen) {
    split_edges(surface, frozen);
    flip_edges(surface, frozen, setting_.guard);
    collapse_edges(surface, frozen, setting_.guard);
    for (int i = 0; i < 2; ++i) {
      flip_edges(surface, frozen, setting_.guard);
      const std::vector<char> settled = frozen_beside(surface.replaced_faces(), surface, frozen);
      for (int k = 0; k < kRelaxations; ++k) relax(surface, settled, setting_.guard, 1);
    }
    repair(surface, frozen, setting_.guard);
  });
  pack(surface_, openings_);
  if (options_.max_vertices > 0 && surface_.vertices().size() > most_vertices_) to_error_ = false;
  // Edge lengths differ a little from the intended sizes; corrects for that.
  aim_ = std::clamp(
      aim_ *
          std::pow(static_cast<double>(wanted_vertices_) / static_cast<double>(surface_.vertices().size()), kAimPower),
      1 / kAimStep, kAimStep);
  find_cones(surface_, field_);
  if (to_error_) step(matches_now(true));  // the next sizes follow from what the error is with these
  change_safely(surface_, [&](FitMesh& surface, const std::vector<char>& frozen) {
    flip_closer(surface, frozen, false, setting_);
  });
}

void Fit::aim_at_error(double p95) {
  if (even_error_ == 0) even_error_ = kEvenShare * error_;
  if (settled_ && p95 > 0) even_error_ *= std::clamp(std::sqrt(kAim * error_ / p95), 1 / kAimStep, kAimStep);
}

}  // namespace vmesh::fitting

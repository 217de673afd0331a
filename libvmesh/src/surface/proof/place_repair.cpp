#include "surface/proof/place_repair.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "vmesh/core/ascending.h"
#include "vmesh/edit/guarded_edit.h"
#include "vmesh/surface/soundness.h"

#include "surface/check/surface_proof.h"
#include "surface/proof/notches.h"
#include "surface/proof/surface_excerpt.h"

namespace vmesh {
namespace {

// Lengths are in units: the square root of limit times radius, of which edges of even surfaces have about 3.5.
// What belongs to a place, the excerpt of the surface in which it is repaired, and the excerpt that is proven in the
// end.
constexpr double kPlace = 16, kChanges = 20, kExcerpt = 26, kProven = 32;
// Of a try: within which vertices are left out, and what else may change around it and is there.
constexpr double kThinned[] = {3, 5, 2, 8, 4, 12};
constexpr double kMoreChanges = 4, kMore = 10;
constexpr double kLeftOut[] = {0.25, 0.5, 0.75, 1};  // shares of the vertices there
constexpr int kPatience = 2;                         // of refining, which is tried again soon
constexpr double kMostVertices = 1.5;                // as many as the excerpt had: a try that needs more gets stuck
constexpr std::size_t kWorthClosing = 2;             // as many unproven faces as before, or fewer

// The same numbers everywhere.
class Chance {
 public:
  std::size_t below(std::size_t n) { return random_() % n; }
  template <class Values>
  auto one_of(const Values& values) {
    return values[below(std::size(values))];
  }

 private:
  std::mt19937 random_;
};

// How many vertices an excerpt may have where the whole may have so many.
std::size_t most_in(const SurfaceExcerpt& excerpt, const FinishedSurface& whole, std::size_t most_in_whole) {
  return most_in_whole - std::min(most_in_whole, whole.mesh.vertices.size() - excerpt.vertex.size());
}

// Unproven faces of an excerpt, but those with a corner at its border.
std::vector<Index> unproven_inside(const FinishedSurface& excerpt, SurfaceProof& proof) {
  std::vector<Index> faces = proof.unproven(excerpt.mesh, excerpt.binding);
  if (faces.empty()) return faces;
  const FinishedMesh mesh = finished_mesh(excerpt);
  std::erase_if(faces, [&](Index f) {
    const Triangle& face = excerpt.mesh.faces[f];
    return std::any_of(face.begin(), face.end(), [&](Index v) { return !mesh.is_inner(v); });
  });
  return faces;
}

// Fewer faces alone may be larger ones.
struct Extent {
  std::size_t faces = 0;
  double area = 0;  // mm2

  bool is_less_than(const Extent& other) const { return faces < other.faces && area < other.area; }
};

Extent unproven_extent(const FinishedSurface& excerpt, SurfaceProof& proof) {
  Extent extent;
  for (const Index f : unproven_inside(excerpt, proof)) {
    const auto& [a, b, c] = excerpt.mesh.faces[f];
    const std::vector<Vec3>& p = excerpt.mesh.vertices;
    ++extent.faces;
    extent.area += (p[b] - p[a]).cross(p[c] - p[a]).norm() / 2;
  }
  return extent;
}

class PlaceRepair {
 public:
  // Keeps references. `poll` throws Cancelled.
  PlaceRepair(const VesselField& field, const RefinementGoal& goal, double unit, const std::function<void()>& poll)
      : field_(field), goal_(goal), unit_(unit), poll_(poll) {
    goal_.patience = kPatience;
    goal_.bends_at_once = true;
  }

  // Returns whether anything has changed.
  bool run(FinishedSurface& place, const RepairEffort& effort) {
    SurfaceProof proof(field_, goal_.limit);
    const std::size_t at_first = unproven_inside(place, proof).size();
    if (at_first > effort.most_unproven) return false;
    notches_ = close_notches(place, field_, goal_.limit).closed_notches;
    std::vector<Index> unproven = unproven_inside(place, proof);
    std::size_t in_vain = 0;
    for (std::size_t tries = 0; in_vain <= effort.most_in_vain && !unproven.empty(); ++tries) {
      poll_();
      const Vec3 around = place.mesh.vertices[place.mesh.faces[chance_.one_of(unproven)][0]];
      if (try_once(place, around, kThinned[tries % std::size(kThinned)])) {
        unproven = unproven_inside(place, proof);
        in_vain = 0;
      } else {
        in_vain += unproven.size();
      }
    }
    return unproven.size() < at_first;
  }

  // Some may have changed after they were closed.
  const std::vector<ClosedNotch>& notches() const { return notches_; }

 private:
  using Step = FinishedMesh::Step;

  bool try_once(FinishedSurface& place, const Vec3& around, double thinned) {
    const SurfaceExcerpt excerpt = cut_out(place, around, (thinned + kMoreChanges) * unit_, (thinned + kMore) * unit_);
    SurfaceProof proof(field_, goal_.limit);
    const Extent now = unproven_extent(excerpt.surface, proof);
    FinishedSurface changed = excerpt.surface;
    leave_out(changed, around, thinned * unit_);
    refine(changed, field_, goal_of(excerpt, place), {});
    Extent then = unproven_extent(changed, proof);
    std::vector<ClosedNotch> notches;
    if (then.faces > 0 && then.faces < kWorthClosing * now.faces) {
      notches = close_notches(changed, field_, goal_.limit).closed_notches;
      then = unproven_extent(changed, proof);
    }
    if (!then.is_less_than(now)) return false;
    put_in(place, excerpt, changed);
    notches_.insert(notches_.end(), notches.begin(), notches.end());
    return true;
  }

  // The usual way of refining every other time, and with rounding often one that knows of kinks.
  int way_of_try() {
    if (chance_.below(2) == 0) return 0;
    const bool at_kinks = field_.relations().blend() > 0 && chance_.below(2) == 0;
    return at_kinks ? chance_.one_of(kWaysAtKinks)
                    : static_cast<int>(chance_.below(static_cast<std::size_t>(refinement_ways())));
  }

  RefinementGoal goal_of(const SurfaceExcerpt& excerpt, const FinishedSurface& place) {
    RefinementGoal goal = goal_;
    goal.way = way_of_try();
    goal.most_vertices = std::min(most_in(excerpt, place, goal.most_vertices),
                                  static_cast<std::size_t>(kMostVertices * static_cast<double>(excerpt.vertex.size())));
    return goal;
  }

  // Leaves out vertices near a point at random.
  void leave_out(FinishedSurface& surface, const Vec3& around, double reach) {
    FinishedMesh mesh = finished_mesh(surface);
    GuardedEdit<FinishedVertex> edit(mesh);
    std::vector<char> held(mesh.vertices().size(), 0);
    for (const Index v : surface.held) held[v] = 1;
    std::vector<std::pair<std::size_t, Index>> order;
    for (Index v = 0; v < held.size(); ++v) {
      if (!held[v] && (mesh.position(v) - around).norm() < reach)
        order.emplace_back(chance_.below(std::size_t{1} << 31), v);
    }
    std::sort(order.begin(), order.end());
    order.resize(static_cast<std::size_t>(chance_.one_of(kLeftOut) * static_cast<double>(order.size())));
    for (const auto& [rank, v] : order) {
      if (mesh.has_vertex(v)) edit.take_best(upright_merges(mesh, v), kWorstSkewness);
    }
    put_back(std::move(mesh), surface);
  }

  // All ways to merge a vertex with one beside it, which stays where it is.
  std::vector<Step> upright_merges(const FinishedMesh& mesh, Index v) const {
    std::vector<Step> steps = merges(mesh, v);
    std::erase_if(steps, [&](const Step& step) { return !stays_upright(mesh, step); });
    return steps;
  }

  bool stays_upright(const FinishedMesh& mesh, const Step& step) const {
    return std::all_of(step.faces.begin(), step.faces.end(), [&](const Triangle& f) {
      const auto& [a, b, c] = mesh.placed(f, step).points;
      const FieldSample s = field_.sample((a + b + c) / 3, mesh.vertex(f[0]).binding.segment);
      return (b - a).cross(c - a).dot(s.gradient) > 0;
    });
  }

  const VesselField& field_;
  RefinementGoal goal_;
  const double unit_;
  const std::function<void()>& poll_;
  Chance chance_;
  std::vector<ClosedNotch> notches_;
};

struct Place {
  Vec3 center;
  double unit;  // mm

  bool holds(const Vec3& p) const { return (p - center).norm() < kPlace * unit; }
};

// So that every unproven face is at one of them.
std::vector<Place> places_in(const RefinementOutcome& outcome, const VesselField& field, const ErrorLimit& limit) {
  std::vector<Place> places;
  for (const Index f : outcome.faces) {
    const Index v = outcome.surface.mesh.faces[f][0];
    const Vec3& p = outcome.surface.mesh.vertices[v];
    if (std::any_of(places.begin(), places.end(), [&](const Place& place) { return place.holds(p); })) continue;
    const auto& [cone, t] = outcome.surface.binding[v];
    const double radius = field.relations().radius_at(cone, t);
    places.push_back({p, std::sqrt(limit.at(radius) * radius)});
  }
  return places;
}

// Faces of the whole at these places.
std::vector<Index> unproven_at(const std::vector<Place>& places, const FinishedSurface& whole, const VesselField& field,
                               const ErrorLimit& limit) {
  std::vector<Index> unproven;
  for (const Place& place : places) {
    const SurfaceExcerpt excerpt = cut_out(whole, place.center, 0, kProven * place.unit);
    SurfaceProof proof(field, limit);
    for (const Index f : unproven_inside(excerpt.surface, proof)) unproven.push_back(excerpt.face[f]);
  }
  sort_unique(unproven);
  return unproven;
}

}  // namespace

void repair_places(RefinementOutcome& outcome, const VesselField& field, const RefinementGoal& goal,
                   const RepairEffort& effort, const Progress& progress) {
  FinishedSurface& whole = outcome.surface;
  const std::vector<Place> places = places_in(outcome, field, goal.limit);
  std::vector<ClosedNotch> notches;
  bool any = false;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& [center, unit] = places[i];
    const std::function<void()> poll = [&] {
      report_progress(progress, "repair", static_cast<double>(i) / static_cast<double>(places.size()));
    };
    const SurfaceExcerpt excerpt = cut_out(whole, center, kChanges * unit, kExcerpt * unit);
    RefinementGoal in_excerpt = goal;
    in_excerpt.most_vertices = most_in(excerpt, whole, goal.most_vertices);
    FinishedSurface changed = excerpt.surface;
    PlaceRepair repair(field, in_excerpt, unit, poll);
    if (!repair.run(changed, effort)) continue;
    put_in(whole, excerpt, changed);
    notches.insert(notches.end(), repair.notches().begin(), repair.notches().end());
    any = true;
  }
  if (!any) return;
  note_unproven(outcome, unproven_at(places, whole, field, goal.limit));
  std::erase_if(notches, [&](const ClosedNotch& notch) {
    return std::find(whole.mesh.vertices.begin(), whole.mesh.vertices.end(), notch.position) ==
           whole.mesh.vertices.end();
  });
  deepest_first(notches);
  outcome.error.closed_notches = std::move(notches);
}

}  // namespace vmesh

#include "solid/layer_stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include "vmesh/core/text.h"

#include "solid/fan_direction.h"
#include "solid/layer_columns.h"
#include "solid/layer_room.h"
#include "solid/layer_shape.h"

namespace vmesh {
namespace {

// Layers are made thinner in steps of this factor where they do not fit.
constexpr double kStep = 0.85;
constexpr double kStepWhereBad = 0.6;  // where tetrahedra turned out bad
// They end below this share of what the gradation leaves of what was asked for: cells would be flatter than any solver
// likes.
constexpr double kLeastShare = 0.02;
// Ways are lengthened where they meet faces obliquely, so that layers keep their height; at most by this factor.
constexpr double kLongest = 2;
// Layers inside leave half as much again free, where tetrahedra have room; those outside only keep off each other,
// unless what is between them is filled with tetrahedra too.
constexpr double kReachInside = 1.5, kReachOutside = 1.1, kReachMerged = 2, kFarther = 2.5;

std::vector<double> levels_of(const LayerOptions& options) {
  std::vector<double> level = {0};
  double height = 1;
  for (int k = 0; k < options.count; ++k, height *= options.growth) level.push_back(level.back() + height);
  const double whole = level.back();
  for (double& share : level) share /= whole;
  level.back() = 1;
  return level;
}

double asked_thickness(const LayerOptions& options, const std::vector<double>& level, double radius) {
  if (options.first_mm > 0) return options.first_mm / level[1];
  return options.in_mm ? options.thickness : options.thickness * radius;
}

// Within the cap's plane, into the cap, across the edges of its rim before and after a vertex.
std::array<Vec3, 2> ways_across_rim(const WallFrame& frame, const Cap& cap, Index v) {
  const std::size_t n = cap.rim.size();
  const auto at = static_cast<std::size_t>(std::find(cap.rim.begin(), cap.rim.end(), v) - cap.rim.begin());
  const Vec3& p = frame.position[v];
  const Vec3 before = p - frame.position[cap.rim[(at + n - 1) % n]], after = frame.position[cap.rim[(at + 1) % n]] - p;
  return {cap.normal.cross(before).normalized(), cap.normal.cross(after).normalized()};
}

class StackBuilder {
 public:
  StackBuilder(const WallFrame& frame, const LayerOptions& options, LayerSide side, const Progress& progress)
      : frame_(frame), progress_(progress) {
    stack_.side = side;
    stack_.reach_if_thin = side == LayerSide::inside ? kReachInside : kReachOutside;
    // The surface that they leave is folded most where they end.
    stack_.reach_at_ends = kFarther * stack_.reach_if_thin;
    stack_.reach = options.merged ? kReachMerged : stack_.reach_if_thin;
    stack_.level = levels_of(options);
    for (const double radius : frame.radius) stack_.asked_mm.push_back(asked_thickness(options, stack_.level, radius));
    stack_.reached_mm = stack_.asked_mm;
    stack_.limit.assign(frame.position.size(), LayerLimit::none);
    find_ways();
  }

  StackBuilder(const WallFrame& frame, LayerStack stack, const Progress& progress)
      : frame_(frame), progress_(progress), stack_(std::move(stack)) {}

  LayerStack run() {
    limit_gradation();
    for (const double thickness : stack_.reached_mm) stack_.least_mm.push_back(kLeastShare * thickness);
    return make_fit();
  }

  // They do not end for this.
  LayerStack run_thinner(const std::vector<Index>& vertices) {
    for (const Index v : vertices) {
      const double thinner = std::max(stack_.least_mm[v], kStepWhereBad * stack_.reached_mm[v]);
      if (!(thinner < stack_.reached_mm[v])) continue;
      stack_.reached_mm[v] = thinner;
      stack_.limit[v] = LayerLimit::shape;
    }
    limit_gradation();
    return make_fit();
  }

 private:
  LayerStack make_fit() {
    do {
      make_well_shaped();
      report_progress(progress_, "layers", 0);
    } while (make_thinner(without_room(), LayerLimit::room));
    return std::move(stack_);
  }

  void find_ways() {
    const std::vector<Vec3> normals = face_normals(frame_);
    const double sign = stack_.side == LayerSide::inside ? -1 : 1;
    for (Index v = 0; v < frame_.position.size(); ++v) {
      std::vector<Vec3> fan;
      for (const Index f : frame_.fan[v]) fan.push_back(sign * normals[f]);
      const FanDirection best =
          frame_.cap_at[v] == kNone ? best_direction(fan) : best_within_cap(v, fan, frame_.caps[frame_.cap_at[v]]);
      if (!(best.least > 0)) end_at(v, LayerLimit::shape);
      double mean = 0;
      for (const Vec3& normal : fan) mean += best.way.dot(normal) / static_cast<double>(fan.size());
      stack_.way.push_back(best.way / std::max(mean, 1 / kLongest));
    }
  }

  // Where the wall bulges over the plane of its cap, what leads away from it leads out of the cap: there is no way
  // then.
  FanDirection best_within_cap(Index v, std::vector<Vec3> fan, const Cap& cap) const {
    const double sign = stack_.side == LayerSide::inside ? 1 : -1;
    for (const Vec3& way : ways_across_rim(frame_, cap, v)) fan.push_back(sign * way);
    return best_direction_in_plane(fan, cap.normal);
  }

  void make_well_shaped() {
    std::vector<Index> due(frame_.faces.size());
    for (Index f = 0; f < due.size(); ++f) due[f] = f;
    while (!due.empty()) {
      std::vector<char> is_due(frame_.position.size(), 0);
      for (const Index f : due) {
        if (is_well_shaped(frame_, stack_, f)) continue;
        for (const Index v : frame_.faces[f]) is_due[v] = 1;
      }
      const std::vector<double> before = stack_.reached_mm;
      make_thinner(is_due, LayerLimit::shape);
      due = faces_at_changes(before);
    }
  }

  std::vector<Index> faces_at_changes(const std::vector<double>& before) const {
    std::vector<Index> faces;
    for (Index v = 0; v < before.size(); ++v) {
      if (before[v] != stack_.reached_mm[v]) faces.insert(faces.end(), frame_.fan[v].begin(), frame_.fan[v].end());
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }

  // Among the layers that have changed since the last call.
  std::vector<char> without_room() {
    std::vector<char> has_changed(frame_.position.size(), 1);
    for (Index v = 0; v < tested_mm_.size(); ++v) has_changed[v] = tested_mm_[v] != stack_.reached_mm[v];
    tested_mm_ = stack_.reached_mm;
    return vertices_without_room(frame_, stack_, has_changed);
  }

  void end_at(Index v, LayerLimit why) {
    stack_.reached_mm[v] = 0;
    stack_.limit[v] = why;
  }

  // Whether there is any of these vertices at which layers have not ended.
  bool make_thinner(const std::vector<char>& is_due, LayerLimit why) {
    bool any = false;
    for (Index v = 0; v < is_due.size(); ++v) {
      if (!is_due[v] || stack_.ends_at(v)) continue;
      any = true;
      stack_.reached_mm[v] *= kStep;
      stack_.limit[v] = why;
      if (stack_.reached_mm[v] < stack_.least_mm[v]) end_at(v, why);
    }
    if (any) limit_gradation();
    return any;
  }

  // The largest thickness below the one there is that differs nowhere by more than the gradation; by Dijkstra's
  // algorithm, from the thinnest on.
  void limit_gradation() {
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> thinnest;
    for (Index v = 0; v < stack_.reached_mm.size(); ++v) thinnest.emplace(stack_.reached_mm[v], v);
    while (!thinnest.empty()) {
      const auto [thickness, v] = thinnest.top();
      thinnest.pop();
      if (thickness > stack_.reached_mm[v]) continue;
      for (const Index f : frame_.fan[v]) {
        for (const Index w : frame_.faces[f]) {
          const double most = thickness + kLayerGradation * (frame_.position[w] - frame_.position[v]).norm();
          if (w == v || stack_.reached_mm[w] <= most) continue;
          stack_.reached_mm[w] = most;
          stack_.limit[w] = LayerLimit::gradation;
          thinnest.emplace(most, w);
        }
      }
    }
  }

  const WallFrame& frame_;
  const Progress& progress_;
  LayerStack stack_;
  std::vector<double> tested_mm_;  // thickness for which there was room, or was not
};

double area_at(const WallFrame& frame, Index v) {
  double area = 0;
  for (const Index f : frame.fan[v]) {
    const auto& [a, b, c] = frame.faces[f];
    const Vec3& p = frame.position[a];
    area += (frame.position[b] - p).cross(frame.position[c] - p).norm() / 6;
  }
  return area;
}

const char* reason_of(LayerLimit limit) {
  switch (limit) {
    case LayerLimit::gradation:
      return "those around are thinner";
    case LayerLimit::shape:
      return "cells would turn over there";
    case LayerLimit::room:
      return "others are in the way";
    case LayerLimit::none:
      break;
  }
  return "no reason";
}

}  // namespace

LayerStack lay_layers(const WallFrame& frame, const LayerOptions& options, LayerSide side, const Progress& progress) {
  return StackBuilder(frame, options, side, progress).run();
}

LayerStack thinned(const WallFrame& frame, const LayerStack& stack, const std::vector<Index>& vertices,
                   const Progress& progress) {
  return StackBuilder(frame, stack, progress).run_thinner(vertices);
}

LayerStack without_layers(const WallFrame& frame, LayerSide side) {
  LayerStack stack;
  stack.side = side;
  stack.way.assign(frame.position.size(), Vec3::Zero());
  stack.asked_mm.assign(frame.position.size(), 0);
  stack.reached_mm = stack.asked_mm;
  return stack;
}

LayerSummary summarize(const WallFrame& frame, const LayerStack& stack) {
  LayerSummary summary;
  if (stack.count() == 0) return summary;
  const auto share = [&](Index v) { return stack.reached_mm[v] / stack.asked_mm[v]; };
  double area = 0, full = 0;
  std::vector<char> seen(frame.position.size(), 0);
  for (Index v = 0; v < seen.size(); ++v) {
    area += area_at(frame, v);
    summary.least_share = std::min(summary.least_share, share(v));
    if (share(v) >= kFullLayers) {
      full += area_at(frame, v);
      seen[v] = 1;
    }
    if (seen[v]) continue;
    std::vector<Index> place = {v};
    seen[v] = 1;
    Index thinnest = v;
    for (std::size_t i = 0; i < place.size(); ++i) {
      if (share(place[i]) < share(thinnest)) thinnest = place[i];
      for (const Index f : frame.fan[place[i]]) {
        for (const Index w : frame.faces[f]) {
          if (seen[w] || share(w) >= kFullLayers) continue;
          seen[w] = 1;
          place.push_back(w);
        }
      }
    }
    summary.thin.push_back({frame.position[thinnest], stack.asked_mm[thinnest], stack.reached_mm[thinnest],
                            place.size(), stack.limit[thinnest]});
  }
  summary.full_share = full / area;
  std::stable_sort(summary.thin.begin(), summary.thin.end(), [](const ThinPlace& a, const ThinPlace& b) {
    return a.reached_mm * b.asked_mm < b.reached_mm * a.asked_mm;
  });
  return summary;
}

std::vector<std::string> sentences_of(const LayerSummary& summary, const std::string& what) {
  constexpr std::size_t kNamed = 3;
  std::vector<std::string> sentences = {what +
                                        formatted(" have at least %g %% of their thickness on %.2f %% of the wall",
                                                  100 * kFullLayers, 100 * summary.full_share)};
  for (std::size_t i = 0; i < std::min(kNamed, summary.thin.size()); ++i) {
    const ThinPlace& place = summary.thin[i];
    const std::string at = " at " + point_text(place.position) + ": " + reason_of(place.limit);
    sentences.push_back(place.reached_mm == 0
                            ? what + " end" + at
                            : what + formatted(" have %.0f %% of it", 100 * place.reached_mm / place.asked_mm) + at);
  }
  if (summary.thin.size() > kNamed)
    sentences.push_back(what + " are thin at " + counted(summary.thin.size() - kNamed, "more place", "more places") +
                        ", listed in the summary");
  return sentences;
}

Disc disc_within(const WallFrame& frame, const Cap& cap, const LayerStack& stack) {
  if (stack.count() == 0) return cap.disc;
  std::vector<Vec3> ring;
  for (const Index v : cap.rim) ring.push_back(stack.at(frame, v, 1));
  return fill_ring(ring, cap.normal);
}

}  // namespace vmesh

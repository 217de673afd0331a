#include "vmesh/surface/followed_surface.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/box_tree.h"
#include "vmesh/core/error.h"
#include "vmesh/surface/branch_labels.h"
#include "vmesh/volume/cone_relations.h"

namespace vmesh {
namespace {

// By how many local radii another branch may be farther away than the nearest and still count.
constexpr double kBlendRadii = 1.5;

void check_followable(const CenterlineEdit& edit) {
  if (!edit.removed_branches.empty())
    throw InvalidInput("a surface cannot follow when branches are removed; grow one around the edited centerline");
}

class BlendedEdit {
 public:
  BlendedEdit(const Centerline& centerline, const CenterlineEdit& edit)
      : relations_(centerline),
        branch_(branch_label_of_cones(centerline)),
        ends_(ends_of_branches(centerline)),
        radius_(centerline, edit.radius),
        scale_(edit.scale),
        boxes_(boxes_of_axes()) {
    for (Index cone = 0; cone < relations_.cone_count(); ++cone)
      widest_ = std::max(widest_, relations_.max_radius(cone));
  }

  Vec3 moved(const Vec3& p) {
    Vec3 sum = Vec3::Zero();
    const double weights = visit_weighted(p, [&](const Place& place, double weight) {
      sum += weight * (radius_.factor(place.cone, place.t) - 1) * (p - relations_.axis_point(place.cone, place.t));
    });
    return scale_ * (p + sum / weights);
  }

  double widening(const Vec3& p) {
    double sum = 0;
    const double weights = visit_weighted(
        p, [&](const Place& place, double weight) { sum += weight * radius_.factor(place.cone, place.t); });
    return scale_ * sum / weights;
  }

 private:
  // The nearest of a branch, by distance in local radii.
  struct Place {
    Index branch, cone;
    double t, radii;
  };

  // Calls visit(place, weight) for the places that count at a point; returns the sum of weights.
  template <class Visit>
  double visit_weighted(const Vec3& p, const Visit& visit) {
    find_places(p);
    const Place& nearest = *std::min_element(places_.begin(), places_.end(),
                                             [](const Place& a, const Place& b) { return a.radii < b.radii; });
    double weights = 0;
    for (const Place& place : places_) {
      const double closeness = 1 - (place.radii - nearest.radii) / kBlendRadii;
      if (!(closeness > 0) || !meet(nearest.branch, place.branch)) continue;
      const double weight = closeness * closeness;
      visit(place, weight);
      weights += weight;
    }
    return weights;
  }

  static std::vector<std::array<Index, 2>> ends_of_branches(const Centerline& centerline) {
    const BranchTable branches(centerline);
    std::vector<std::array<Index, 2>> ends;
    for (Index b = 0; b < branches.size(); ++b) ends.push_back({branches.nodes(b).front(), branches.nodes(b).back()});
    return ends;
  }

  // Others that come near are no part of the same volume.
  bool meet(Index a, Index b) const {
    if (a == b) return true;
    if (std::max(a, b) >= ends_.size()) return false;  // an isolated node
    return std::find_first_of(ends_[a].begin(), ends_[a].end(), ends_[b].begin(), ends_[b].end()) != ends_[a].end();
  }

  BoxTree boxes_of_axes() const {
    std::vector<Vec3> low, high;
    for (Index cone = 0; cone < relations_.cone_count(); ++cone) {
      const Vec3 a = relations_.axis_point(cone, 0), b = relations_.axis_point(cone, 1);
      low.push_back(a.cwiseMin(b));
      high.push_back(a.cwiseMax(b));
    }
    return {low, high};
  }

  Place place_on(Index cone, const Vec3& p) const {
    const Vec3 a = relations_.axis_point(cone, 0), along = relations_.axis_point(cone, 1) - a;
    const double squared = along.squaredNorm(), t = squared > 0 ? std::clamp(along.dot(p - a) / squared, 0.0, 1.0) : 0;
    return {branch_[cone], cone, t, (p - a - t * along).norm() / relations_.radius_at(cone, t)};
  }

  // One for each branch that may count.
  void find_places(const Vec3& p) {
    places_.clear();
    double nearest = std::numeric_limits<double>::infinity(), limit = nearest;
    boxes_.visit(p, limit, [&](Index cone) {
      const Place place = place_on(cone, p);
      nearest = std::min(nearest, place.radii);
      limit = (nearest + kBlendRadii) * widest_;
      const auto same = std::find_if(places_.begin(), places_.end(),
                                     [&](const Place& other) { return other.branch == place.branch; });
      if (same == places_.end()) {
        places_.push_back(place);
      } else if (place.radii < same->radii || (place.radii == same->radii && place.cone < same->cone)) {
        *same = place;
      }
    });
    // Sums do not depend on the order of boxes.
    std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.branch < b.branch; });
  }

  ConeRelations relations_;
  std::vector<Index> branch_;               // of cones
  std::vector<std::array<Index, 2>> ends_;  // nodes, of branches
  ChangedRadius radius_;
  double scale_, widest_ = 0;
  BoxTree boxes_;
  std::vector<Place> places_;
};

template <class Value>
std::vector<Value> at_all(const std::vector<Vec3>& points, const Centerline& centerline, const CenterlineEdit& edit,
                          Value (BlendedEdit::*value)(const Vec3&)) {
  check_followable(edit);
  if (centerline.nodes().empty()) throw InvalidInput("there are no vessels for the points to follow");
  BlendedEdit blended(centerline, edit);
  std::vector<Value> values;
  values.reserve(points.size());
  for (const Vec3& p : points) values.push_back((blended.*value)(p));
  return values;
}

}  // namespace

std::vector<Vec3> follow_edit(const std::vector<Vec3>& vertices, const std::vector<CenterlineBinding>& binding,
                              const Centerline& centerline, const CenterlineEdit& edit) {
  check_followable(edit);
  if (binding.size() != vertices.size())
    throw InvalidInput("the surface has " + std::to_string(vertices.size()) + " vertices, but " +
                       std::to_string(binding.size()) + " are bound to the centerline");
  const ConeRelations relations(centerline);
  const ChangedRadius radius(centerline, edit.radius);
  std::vector<Vec3> moved;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto& [segment, t] = binding[v];
    if (segment >= relations.cone_count())
      throw InvalidInput("vertex " + std::to_string(v) + " is bound to segment " + std::to_string(segment) +
                         ", which the centerline does not have");
    const Vec3 axis = relations.axis_point(segment, t);
    moved.push_back(edit.scale * (axis + radius.factor(segment, t) * (vertices[v] - axis)));
  }
  return moved;
}

std::vector<Vec3> follow_edit_within(const std::vector<Vec3>& points, const Centerline& centerline,
                                     const CenterlineEdit& edit) {
  return at_all(points, centerline, edit, &BlendedEdit::moved);
}

std::vector<double> widening_within(const std::vector<Vec3>& points, const Centerline& centerline,
                                    const CenterlineEdit& edit) {
  return at_all(points, centerline, edit, &BlendedEdit::widening);
}

}  // namespace vmesh

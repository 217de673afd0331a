#include "volume/rounded_over.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "vmesh/core/ascending.h"
#include "vmesh/core/box_tree.h"
#include "vmesh/volume/round_cone.h"

namespace vmesh {
namespace {

constexpr double kSphereStep = 0.5;  // mean radii between two spheres that represent a cone
constexpr double kMostSpheres = 200;
constexpr double kRoundingInBoxes = 16 * std::numeric_limits<double>::epsilon();  // relative to coordinates

using Lists = std::vector<std::vector<Index>>;

class RoundedOver {
 public:
  explicit RoundedOver(const ConeRelations& relations)
      : relations_(relations), added_(relations.cone_count()), mark_(relations.cone_count(), kNone) {
    cones_.reserve(relations.cone_count());
    const Centerline& centerline = relations.centerline();
    for (Index c = 0; c < relations.cone_count(); ++c)
      cones_.emplace_back(centerline.node(relations.first_node(c)), centerline.node(relations.last_node(c)));
    tree_ = BoxTree(static_cast<Index>(cones_.size()), [this](Index c) { return box_of(c, relations_.blend()); });
  }

  // What is added for one cone may make others reach it, so the cones next to it are visited again.
  std::vector<std::pair<Index, Index>> find() {
    std::vector<Index> visited(cones_.size());
    for (Index c = 0; c < cones_.size(); ++c) visited[c] = c;
    std::vector<std::pair<Index, Index>> all;
    while (!visited.empty()) {
      std::vector<std::pair<Index, Index>> found;
      for (const Index c : visited) visit(c, found);
      sort_unique(found);
      visited.clear();
      for (const auto& [c, j] : found) {
        added_[c].push_back(j);
        added_[j].push_back(c);
      }
      for (const auto& [c, j] : found) {
        for (const Index end : {c, j}) for_local(end, [&](Index i) { visited.push_back(i); });
      }
      sort_unique(visited);
      all.insert(all.end(), found.begin(), found.end());
    }
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  struct Near {
    Index cone;
    double value, reach;  // distance and widest blend, mm
    Vec3 gradient;
  };

  template <class Visit>
  void for_local(Index c, Visit&& visit) const {
    for (const Index i : relations_.local_cones(c)) visit(i);
    for (const Index i : added_[c]) visit(i);
  }

  // The box of a cone, grown by `share` of its larger radius and more than rounding can make of that.
  BoxTree::Box box_of(Index c, double share) const {
    const RoundCone& cone = cones_[c];
    const double widest = std::max(cone.r0, cone.r1);
    const Vec3 end = cone.origin + cone.axis;
    const double size = cone.origin.cwiseAbs().cwiseMax(end.cwiseAbs()).maxCoeff();
    const double around = (1 + share) * widest + kRoundingInBoxes * (size + widest);
    return {cone.origin.cwiseMin(end).array() - around, cone.origin.cwiseMax(end).array() + around};
  }

  void visit(Index c, std::vector<std::pair<Index, Index>>& found) {
    for_local(c, [&](Index i) { mark_[i] = c; });
    others_.clear();
    const BoxTree::Box box = box_of(c, 0);
    tree_.visit_overlapping(box.low, box.high, [&](Index j) {
      if (mark_[j] == c) return;
      bool meet = false;
      for_local(j, [&](Index i) { meet = meet || mark_[i] == c; });
      if (meet && !apart(c, j)) others_.push_back(j);
    });
    if (!others_.empty()) {
      const RoundCone& cone = cones_[c];
      const double spheres = std::ceil(cone.axis.norm() / (kSphereStep * cone.radius_at(0.5)));
      const double count = std::clamp(spheres, 1.0, kMostSpheres);
      for (double k = 0; k <= count && !others_.empty(); ++k) visit_sphere(c, k / count, found);
    }
    for_local(c, [&](Index i) { mark_[i] = kNone; });
  }

  void visit_sphere(Index c, double t, std::vector<std::pair<Index, Index>>& found) {
    const Vec3 p = cones_[c].origin + t * cones_[c].axis;
    const double radius = cones_[c].radius_at(t);
    bool is_known = false;  // near_
    std::erase_if(others_, [&](Index j) {
      const Near other = near_at(p, j);
      if (other.value >= radius + other.reach) return false;
      if (!is_known) find_near(c, p, radius);
      is_known = true;
      const bool reaches = std::any_of(near_.begin(), near_.end(), [&](const Near& n) {
        return rounding_reaches(n, other, radius) && !apart(n.cone, j) && are_local(n.cone, j);
      });
      if (reaches) found.push_back(std::minmax(c, j));
      return reaches;
    });
  }

  void find_near(Index c, const Vec3& p, double radius) {
    near_.clear();
    for_local(c, [&](Index i) {
      if (const Near n = near_at(p, i); n.value < radius + n.reach) near_.push_back(n);
    });
  }

  Near near_at(const Vec3& p, Index i) const {
    const auto [value, t] = cones_[i].distance_to(p);
    const double reach = relations_.blend() * cones_[i].radius_at(t) * relations_.rounding_at(i, t);
    return {i, value, reach, cones_[i].gradient(p, t)};
  }

  // As VesselField blends. Whether the boundary of the two, rounded, comes as near to a point as the radius.
  static bool rounding_reaches(const Near& a, const Near& b, double radius) {
    const double width = std::min(a.reach, b.reach) * (1 - a.gradient.dot(b.gradient));
    const double room = width - std::abs(a.value - b.value);
    if (room <= 0) return false;
    return std::min(a.value, b.value) - room * room / (4 * width) < radius;
  }

  bool apart(Index i, Index j) const {
    const auto& apart = relations_.apart();
    return !apart.empty() && std::binary_search(apart.begin(), apart.end(), std::pair<Index, Index>(std::minmax(i, j)));
  }

  bool are_local(Index i, Index j) const {
    const auto local = relations_.local_cones(i);
    return std::binary_search(local.begin(), local.end(), j) ||
           std::find(added_[i].begin(), added_[i].end(), j) != added_[i].end();
  }

  const ConeRelations& relations_;
  std::vector<RoundCone> cones_;
  BoxTree tree_;  // of what the blend of a cone reaches
  Lists added_;
  std::vector<Index> mark_;  // of the cone for which one was seen last
  std::vector<Index> others_;
  std::vector<Near> near_;
};

}  // namespace

std::vector<std::pair<Index, Index>> rounded_over(const ConeRelations& relations) {
  if (relations.blend() == 0) return {};
  return RoundedOver(relations).find();
}

}  // namespace vmesh

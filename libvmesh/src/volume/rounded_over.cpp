#include "volume/rounded_over.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "vmesh/core/ascending.h"
#include "vmesh/core/box_tree.h"
#include "vmesh/volume/round_cone.h"

namespace vmesh {
namespace {

constexpr double kSphereStep = 0.5;  // mean radii between two spheres that represent a cone
constexpr double kMostSpheres = 200;
constexpr double kRoundingInBoxes = 16 * std::numeric_limits<double>::epsilon();  // relative to coordinates

constexpr std::size_t kBlock = 4096;  // cones visited one after the other; each takes a mark of every cone

using Lists = std::vector<std::vector<Index>>;
using Pairs = std::vector<std::pair<Index, Index>>;

class RoundedOver {
 public:
  explicit RoundedOver(const ConeRelations& relations) : relations_(relations), added_(relations.cone_count()) {
    cones_.reserve(relations.cone_count());
    const Centerline& centerline = relations.centerline();
    for (Index c = 0; c < relations.cone_count(); ++c)
      cones_.emplace_back(centerline.node(relations.first_node(c)), centerline.node(relations.last_node(c)));
    tree_ = BoxTree(static_cast<Index>(cones_.size()), [this](Index c) { return box_of(c, relations_.blend()); });
  }

  // What is added for one cone may make others reach it, so the cones next to it are visited again.
  Pairs find() {
    std::vector<Index> visited(cones_.size());
    for (Index c = 0; c < cones_.size(); ++c) visited[c] = c;
    Pairs all;
    while (!visited.empty()) {
      const Pairs found = visit_all(visited);
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

  // What it takes to visit cones one after the other.
  struct Visitor {
    std::vector<Index> mark;  // of every cone, that for which it was seen last
    std::vector<Index> others;
    std::vector<Near> near;
    Pairs found;
  };

  // Isolated: a thread that waits for others does not start on a piece of a growing surface.
  Pairs visit_all(const std::vector<Index>& cones) const {
    std::vector<Pairs> blocks((cones.size() + kBlock - 1) / kBlock);
    const auto visit_block = [&](std::size_t b) {
      Visitor visitor;
      visitor.mark.assign(cones_.size(), kNone);
      for (std::size_t i = b * kBlock; i < std::min(cones.size(), (b + 1) * kBlock); ++i) visit(cones[i], visitor);
      blocks[b] = std::move(visitor.found);
    };
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, blocks.size(), visit_block); });
    Pairs found;
    for (const Pairs& some : blocks) found.insert(found.end(), some.begin(), some.end());
    sort_unique(found);
    return found;
  }

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

  void visit(Index c, Visitor& visitor) const {
    std::vector<Index>&mark = visitor.mark, &others = visitor.others;
    for_local(c, [&](Index i) { mark[i] = c; });
    others.clear();
    const BoxTree::Box box = box_of(c, 0);
    tree_.visit_overlapping(box.low, box.high, [&](Index j) {
      if (mark[j] == c) return;
      bool meet = false;
      for_local(j, [&](Index i) { meet = meet || mark[i] == c; });
      if (meet && !apart(c, j)) others.push_back(j);
    });
    if (!others.empty()) {
      const RoundCone& cone = cones_[c];
      const double spheres = std::ceil(cone.axis.norm() / (kSphereStep * cone.radius_at(0.5)));
      const double count = std::clamp(spheres, 1.0, kMostSpheres);
      for (double k = 0; k <= count && !others.empty(); ++k) visit_sphere(c, k / count, visitor);
    }
    for_local(c, [&](Index i) { mark[i] = kNone; });
  }

  void visit_sphere(Index c, double t, Visitor& visitor) const {
    const Vec3 p = cones_[c].origin + t * cones_[c].axis;
    const double radius = cones_[c].radius_at(t);
    bool is_known = false;  // what is near
    std::erase_if(visitor.others, [&](Index j) {
      const Near other = near_at(p, j);
      if (other.value >= radius + other.reach) return false;
      if (!is_known) find_near(c, p, radius, visitor.near);
      is_known = true;
      const bool reaches = std::any_of(visitor.near.begin(), visitor.near.end(), [&](const Near& n) {
        return rounding_reaches(n, other, radius) && !apart(n.cone, j) && are_local(n.cone, j);
      });
      if (reaches) visitor.found.push_back(std::minmax(c, j));
      return reaches;
    });
  }

  void find_near(Index c, const Vec3& p, double radius, std::vector<Near>& near) const {
    near.clear();
    for_local(c, [&](Index i) {
      if (const Near n = near_at(p, i); n.value < radius + n.reach) near.push_back(n);
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
};

}  // namespace

std::vector<std::pair<Index, Index>> rounded_over(const ConeRelations& relations) {
  if (relations.blend() == 0) return {};
  return RoundedOver(relations).find();
}

}  // namespace vmesh

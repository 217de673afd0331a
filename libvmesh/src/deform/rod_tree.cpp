#include "vmesh/deform/rod_tree.h"

namespace vmesh {
namespace {

Mat3 frame_along(const Vec3& z) {
  Mat3 frame;
  frame.col(2) = z;
  frame.col(0) = z.unitOrthogonal();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

/// `parent` rotated the short way until its z is `z`, then orthonormalised: rotation alone doubles the error with every
/// segment.
Mat3 transported(const Mat3& parent, const Vec3& z) {
  const Vec3 old_z = parent.col(2);
  Vec3 x = parent.col(0);
  const double cosine = old_z.dot(z);
  if (cosine > -0.999) x -= z.dot(x) / (1 + cosine) * (old_z + z);
  x -= z.dot(x) * z;
  if (x.squaredNorm() < 1e-6) x = z.unitOrthogonal();
  Mat3 frame;
  frame.col(2) = z;
  frame.col(0) = x.normalized();
  frame.col(1) = z.cross(frame.col(0));
  return frame;
}

class Builder {
 public:
  explicit Builder(const Centerline& centerline) : centerline_(centerline), used_(centerline.segments().size()) {
    tree_.slot_of_node.assign(centerline.nodes().size(), kNone);
    tree_.slot_of_segment.assign(centerline.segments().size(), kNone);
  }

  RodTree run(std::span<const Index> roots) {
    for (const Index n : roots)
      if (tree_.slot_of_node[n] == kNone) visit_component(n);
    for (Index n = 0; n < centerline_.nodes().size(); ++n)
      if (tree_.slot_of_node[n] == kNone) visit_component(n);
    return std::move(tree_);
  }

 private:
  struct Visit {
    Index node, parent, segment;
  };

  void visit_component(Index root) {
    add_slot({root, kNone, kNone});
    while (!pending_.empty()) {
      const Visit next = pending_.back();
      pending_.pop_back();
      if (used_[next.segment]) continue;
      used_[next.segment] = true;
      add_slot(next);
    }
  }

  void add_slot(const Visit& visit) {
    const Index slot = static_cast<Index>(tree_.size());
    tree_.parent.push_back(visit.parent);
    tree_.segment.push_back(visit.segment);
    tree_.node.push_back(visit.node);
    tree_.position.push_back(centerline_.node(visit.node).position);
    tree_.radius.push_back(centerline_.node(visit.node).radius);
    add_frame(visit);
    if (visit.segment != kNone) tree_.slot_of_segment[visit.segment] = slot;
    if (tree_.slot_of_node[visit.node] != kNone) {
      tree_.ties.push_back({slot, tree_.slot_of_node[visit.node]});
      return;
    }
    tree_.slot_of_node[visit.node] = slot;
    const auto incident = centerline_.incident_segments(visit.node);
    for (auto s = incident.rbegin(); s != incident.rend(); ++s)
      if (!used_[*s]) pending_.push_back({centerline_.other_node(*s, visit.node), slot, *s});
  }

  void add_frame(const Visit& visit) {
    if (visit.parent == kNone) {
      tree_.length.push_back(0);
      tree_.frame.push_back(root_frame(visit.node));
      tree_.turn.push_back(Mat3::Identity());
      return;
    }
    const Mat3& parent = tree_.frame[visit.parent];
    const Vec3 along = tree_.position.back() - tree_.position[visit.parent];
    const Vec3 z = along.stableNormalized();
    const Mat3 frame = transported(parent, z.squaredNorm() > 0.5 ? z : Vec3(parent.col(2)));
    tree_.length.push_back(along.stableNorm());
    tree_.turn.push_back(parent.transpose() * frame);
    tree_.frame.push_back(frame);
  }

  Mat3 root_frame(Index node) const {
    const auto incident = centerline_.incident_segments(node);
    if (incident.empty()) return Mat3::Identity();
    const Index other = centerline_.other_node(incident.front(), node);
    const Vec3 z = (centerline_.node(other).position - centerline_.node(node).position).stableNormalized();
    return frame_along(z.squaredNorm() > 0.5 ? z : Vec3(Vec3::UnitZ()));
  }

  const Centerline& centerline_;
  std::vector<char> used_;
  std::vector<Visit> pending_;
  RodTree tree_;
};

}  // namespace

RodTree make_rod_tree(const Centerline& centerline, std::span<const Index> roots) {
  return Builder(centerline).run(roots);
}

Pose rest_pose(const RodTree& tree) { return {tree.position, tree.frame, {}}; }

}  // namespace vmesh

#include "parted_tree.h"

#include "vmesh/core/error.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/cut_surface.h"

namespace vmesh {
namespace {

/// Cuts nearer to each other than this, in radii, are the same.
constexpr double kSamePlace = 1e-3;

bool same(const SegmentPlace& a, const SegmentPlace& b) { return a.segment == b.segment && a.t == b.t; }

}  // namespace

SegmentPlace PartedTree::now(SegmentPlace place) const {
  for (std::size_t i = 0; i < cuts_; ++i) place = made_[i].cut.after(place);
  return place;
}

SegmentPlace PartedTree::whole(SegmentPlace place) const {
  for (std::size_t i = cuts_; i-- > 0;) place = made_[i].cut.before(place);
  return place;
}

CenterlineCut PartedTree::cut_there(const SegmentPlace& at) const {
  const Centerline& whole = stages_.front().centerline;
  if (at.segment >= whole.segments().size()) throw InvalidInput("there is no vessel to cut there");
  const Vec3 position = whole.point_at(at.segment, at.t);
  const double near = kSamePlace * whole.radius_at(at.segment, at.t);
  for (std::size_t i = 0; i < cuts_; ++i)
    if ((made_[i].cut.position - position).norm() <= near) throw InvalidInput("the vessel is cut there already");
  return cut_centerline(now().centerline, now(at));
}

const CenterlineCut& PartedTree::next_cut(const SegmentPlace& at) {
  if (cuts_ < made_.size() && same(made_[cuts_].at, at)) return made_[cuts_].cut;
  CenterlineCut cut = cut_there(at);
  CutSurface surface = cut_surface(now().mesh, now().binding, now().centerline, cut,
                                   [this](const SegmentPlace& place) { return whole(place); });
  made_.erase(made_.begin() + static_cast<std::ptrdiff_t>(cuts_), made_.end());
  stages_.erase(stages_.begin() + static_cast<std::ptrdiff_t>(cuts_) + 1, stages_.end());
  std::vector<Vec3> normals = vertex_normals(surface.mesh);
  stages_.push_back({cut.centerline, std::move(surface.mesh), std::move(normals), std::move(surface.binding)});
  made_.push_back({at, std::move(cut)});
  return made_.back().cut;
}

}  // namespace vmesh

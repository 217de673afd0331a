#include "deformation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vmesh/core/error.h"
#include "vmesh/surface/cut_surface.h"

namespace vmesh::python {
namespace {

/// The labels of caps go on with those of the cut.
FlatEnds ends_of_cut(const FlatEnds& before, const CutSurface& cut, const CenterlineCut& at) {
  if (before.cap_label.empty()) return {};
  FlatEnds after = before;
  const Index last = *std::max_element(before.cap_label.begin(), before.cap_label.end());
  after.cap_label.clear();
  for (Index f = 0; f < cut.face_origin.size(); ++f) {
    const Index from = cut.face_origin[f];
    const Index of_cap = last + (f >= cut.cap[1].first_face ? 2 : 1);
    after.cap_label.push_back(from == kNone ? of_cap : before.cap_label[from]);
  }
  for (Index side = 0; side < 2; ++side) {
    FlatEnd end;
    end.label = last + 1 + side;
    end.node = at.end[side];
    end.center = at.position;
    end.normal = side == 0 ? at.direction : Vec3(-at.direction);
    end.capped = true;
    after.ends.push_back(end);
  }
  return after;
}

/// The surface at rest after a cut, bound to the centerline after it.
SurfacePtr cut_apart(const SurfaceObject& before, const CenterlineCut& cut) {
  CutSurface made = cut_surface(before.mesh(), before.result.binding, centerline_of(before), cut);
  auto after = std::make_shared<SurfaceObject>();
  after->centerline = std::make_shared<CenterlineObject>(CenterlineObject{cut.centerline, {}, {}, {}});
  after->ends = ends_of_cut(before.ends, made, cut);
  for (const auto& [a, b, share] : made.vertex_origin)
    after->result.radius.push_back((1 - share) * before.result.radius[a] + share * before.result.radius[b]);
  after->result.openings = before.result.openings;
  after->result.binding = std::move(made.binding);
  after->result.mesh = std::move(made.mesh);
  return after;
}

}  // namespace

const Centerline& centerline_of(const SurfaceObject& surface) {
  if (!surface.centerline)
    throw InvalidInput(
        "the surface is not bound to a centerline: read or make it with the one around which it was grown");
  return surface.centerline->centerline;
}

Deformation::Deformation(SurfacePtr surface, const Material& material, const SimulationOptions& options)
    : surface_(std::move(surface)),
      simulation_(centerline_of(*surface_), segment_properties(centerline_of(*surface_), material), options),
      binding_(centerline_of(*surface_), simulation_.tree(), surface_->mesh().vertices,
               vertex_normals(surface_->mesh()), places_of(*surface_)),
      lanes_(binding_.make_surface(SurfaceBinding::Normals::with)),
      step_s_(options.step_s),
      vertices_(surface_->mesh().vertices.size()),
      normals_(vertices_.size()),
      nodes_(centerline_of(*surface_).nodes().size()) {
  gather();
}

StepReport Deformation::advance() {
  ++steps_;
  close_clips();
  return simulation_.step();
}

std::array<Index, 2> Deformation::cut(const CenterlineCut& cut) {
  SurfacePtr after = cut_apart(*surface_, cut);
  simulation_.cut(cut);
  begin_again(std::move(after));
  return cut.end;
}

std::vector<Index> Deformation::clip(const SegmentPlace& place, const Clip& clip, double closing_s) {
  if (!(closing_s >= 0 && std::isfinite(closing_s)))
    throw InvalidInput("the time in which a clip closes must be finite and at least 0");
  const ClippedVessel clipped = clip_vessel(centerline_of(*surface_), place, clip);
  auto after = std::make_shared<SurfaceObject>(*surface_);
  for (const InsertedNode& node : clipped.inserted) {
    simulation_.divide(node);
    for (CenterlineBinding& binding : after->result.binding) {
      const SegmentPlace now = node.after({binding.segment, binding.t});
      binding = {now.segment, now.t};
    }
    after->centerline = std::make_shared<CenterlineObject>(CenterlineObject{node.centerline, {}, {}, {}});
  }
  if (!clipped.inserted.empty()) begin_again(std::move(after));
  std::vector<Index> nodes;
  for (const auto& [node, scale] : clipped.scales) {
    closing_.push_back({node, scale, time(), closing_s});
    nodes.push_back(node);
  }
  return nodes;
}

void Deformation::synchronise() {
  binding_.apply(simulation_.pose(), simulation_.moved(), lanes_);
  simulation_.clear_moved();
  gather();
}

void Deformation::close_clips() {
  std::erase_if(closing_, [this](const Closing& c) {
    const double part = c.duration_s > 0 ? std::min(1.0, (time() - c.from_s) / c.duration_s) : 1;
    simulation_.set_radial_scale(c.node, 1 + part * (c.scale - 1));
    return part == 1;
  });
}

void Deformation::begin_again(SurfacePtr surface) {
  surface_ = std::move(surface);
  const std::vector<Vec3>& rest = surface_->mesh().vertices;
  binding_ = SurfaceBinding(centerline_of(*surface_), simulation_.tree(), rest, vertex_normals(surface_->mesh()),
                            places_of(*surface_));
  lanes_ = binding_.make_surface(SurfaceBinding::Normals::with);
  binding_.apply(simulation_.pose(), lanes_);
  // Views of the arrays until now must outlive the change.
  for (std::vector<Vec3>* array : {&vertices_, &normals_, &nodes_}) former_.push_back(std::move(*array));
  vertices_.assign(rest.size(), Vec3::Zero());
  normals_ = vertices_;
  nodes_.assign(centerline_of(*surface_).nodes().size(), Vec3::Zero());
  gather();
}

void Deformation::gather() {
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    const Index lane = binding_.lane_of_vertex()[v];
    vertices_[v] = lanes_.position(lane);
    normals_[v] = lanes_.normal(lane);
  }
  for (std::size_t n = 0; n < nodes_.size(); ++n) nodes_[n] = simulation_.position(static_cast<Index>(n));
}

}  // namespace vmesh::python

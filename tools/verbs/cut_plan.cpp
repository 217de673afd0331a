#include "verbs/cut_plan.h"

#include <algorithm>

#include "vmesh/core/disjoint_sets.h"
#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/deform/surface_binding.h"
#include "vmesh/mesh/patch_names.h"
#include "vmesh/mesh/topology.h"

namespace vmesh::tool {
namespace {

/// Cuts nearer to each other than this, in radii, are the same.
constexpr double kSamePlace = 1e-3;

template <class Step>
std::vector<CenterlineBinding> moved_on(const std::vector<CenterlineBinding>& binding, const Step& step, bool back) {
  std::vector<CenterlineBinding> moved;
  for (const auto& [segment, t] : binding) {
    const SegmentPlace place = back ? step.before({segment, t}) : step.after({segment, t});
    moved.push_back({place.segment, place.t});
  }
  return moved;
}

/// Volumes of the components with the two caps; one if they are the same.
std::vector<double> part_volumes(const CutSurface& surface) {
  const TriMesh& mesh = surface.mesh;
  DisjointSets parts(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.faces) parts.join(a, b), parts.join(b, c);
  std::vector<double> volumes;
  for (const CutSurface::Cap& cap : surface.cap) {
    const Index part = parts.find(cap.vertex);
    TriMesh one{mesh.vertices, {}};
    for (const Triangle& face : mesh.faces) {
      if (parts.find(face[0]) == part) one.faces.push_back(face);
    }
    volumes.push_back(enclosed_volume(one));
    if (parts.find(surface.cap[1].vertex) == part) break;
  }
  return volumes;
}

SegmentPlace place_at_node(const Centerline& centerline, Index node) {
  const Index segment = centerline.incident_segments(node)[0];
  return {segment, centerline.segment(segment).b == node ? 1.0 : 0.0};
}

}  // namespace

CutPlan::CutPlan(const Scene& scene, const std::string& source, BoundTree rest)
    : source_(source), original_(rest.centerline) {
  stages_.push_back(std::move(rest));
  for (const Scene::Clip& clip : scene.clips) add_clip(scene, clip);
  std::vector<Scene::Cut> cuts = scene.cuts;
  std::stable_sort(cuts.begin(), cuts.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  for (const Scene::Cut& cut : cuts) add_cut(cut);
}

void CutPlan::fail(const Scene::Place& place, const std::string& what) const {
  throw InvalidInput(source_ + ": " + place.element + ": " + what);
}

/// What the library says, with the element.
template <class Function>
auto CutPlan::naming_element(const Scene::Place& place, Function function) const {
  try {
    return function();
  } catch (const InvalidInput& error) {
    fail(place, error.what());
  }
}

/// On the centerline of before all; of a node, on one of its segments.
SegmentPlace CutPlan::resolved(const Scene::Place& place) const {
  if (place.node != kNone) {
    if (original_.degree(place.node) == 0) fail(place, "no vessel leads to node " + std::to_string(place.node));
    return place_at_node(original_, place.node);
  }
  SegmentPlace at{place.segment, place.t};
  if (place.position_mm) {
    const SurfacePlace nearest = nearest_places(original_, std::span(&*place.position_mm, 1)).front();
    at = {nearest.segment, nearest.t};
  }
  if (at.segment >= original_.segments().size())
    fail(place, "there is no segment " + std::to_string(at.segment) + "; there are " +
                    std::to_string(original_.segments().size()) + ", numbered from 0");
  return at;
}

/// From the centerline of before all to the last one so far.
SegmentPlace CutPlan::now(SegmentPlace place) const {
  for (const InsertedNode& node : inserted_) place = node.after(place);
  for (const Made& made : cuts_) place = made.cut.after(place);
  return place;
}

SegmentPlace CutPlan::original(SegmentPlace place) const {
  for (std::size_t i = cuts_.size(); i-- > 0;) place = cuts_[i].cut.before(place);
  for (std::size_t i = inserted_.size(); i-- > 0;) place = inserted_[i].before(place);
  return place;
}

void CutPlan::add_clip(const Scene& scene, const Scene::Clip& clip) {
  const SegmentPlace place = resolved(clip.place);
  BoundTree& tree = stages_.front();
  const ClippedVessel clipped = naming_element(clip.place, [&] {
    return clip_vessel(tree.centerline, now(place), {clip.width_mm, clip.scale});
  });
  for (const InsertedNode& node : clipped.inserted) {
    inserted_.push_back(node);
    tree.binding = moved_on(tree.binding, node, false);
    tree.centerline = node.centerline;
  }
  for (const auto& [node, scale] : clipped.scales) {
    const auto is_node = [&, n = node](const Scene::Profile& other) { return other.node == n; };
    if (std::any_of(scene.scales.begin(), scene.scales.end(), is_node) ||
        std::any_of(profiles_.begin(), profiles_.end(), is_node))
      fail(clip.place,
           "the profile of the vessel is given there already, by radial_scale of a node or another clip; "
           "leave out one of the two");
    profiles_.push_back({node, {{clip.time_s, clip.time_s + clip.closing_s}, {1, scale}}});
  }
  clips_.push_back({clip, place, original_.point_at(place.segment, place.t), clipped.width_mm});
}

CenterlineCut CutPlan::cut_there(const Scene::Place& place, const SegmentPlace& at) const {
  const Centerline& centerline = stages_.back().centerline;
  const Vec3 position = original_.point_at(at.segment, at.t);
  const double near = kSamePlace * original_.radius_at(at.segment, at.t);
  for (const Made& made : cuts_) {
    if ((made.cut.position - position).norm() <= near)
      fail(place, "the vessel is cut there already, by " + made.element);
  }
  return naming_element(place, [&] {
    return place.node != kNone ? cut_at_node(centerline, place.node) : cut_centerline(centerline, now(at));
  });
}

void CutPlan::add_cut(const Scene::Cut& cut) {
  const SegmentPlace at = resolved(cut.place);
  CenterlineCut parted = cut_there(cut.place, at);
  const BoundTree& before = stages_.back();
  const CutSurface surface = naming_element(cut.place, [&] {
    return cut_surface(before.mesh, before.binding, before.centerline, parted,
                       [this](const SegmentPlace& place) { return original(place); });
  });
  const std::string number = std::to_string(cuts_.size() + 1);
  const std::array<std::string, 2> caps = {"cut_" + number + "a", "cut_" + number + "b"};
  BoundTree after{parted.centerline, surface.mesh,
                  attributes_of_cut(before.attributes, surface, at, parted.radius, caps), surface.binding};
  naming_element(cut.place, [&] {
    check_patch_names(after.attributes.patch_names, "patch", "patches");
    return true;
  });
  cuts_.push_back(
      {cut.place.element, cut.time_s, at, std::move(parted), caps, surface.cap_area_mm2, part_volumes(surface)});
  stages_.push_back(std::move(after));
}

std::vector<CenterlineBinding> CutPlan::last_on(std::size_t stage) const {
  std::vector<CenterlineBinding> binding = stages_.back().binding;
  for (std::size_t i = cuts_.size(); i-- > stage;) binding = moved_on(binding, cuts_[i].cut, true);
  return binding;
}

SegmentPlace CutPlan::place_of_node(Index node, std::size_t stage) const {
  SegmentPlace place = place_at_node(stages_.back().centerline, node);
  for (std::size_t i = cuts_.size(); i-- > stage;) place = cuts_[i].cut.before(place);
  return place;
}

Json CutPlan::cuts_json() const {
  Json all = Json::array();
  for (const Made& made : cuts_)
    all.push_back({{"element", made.element},
                   {"time_s", made.time_s},
                   {"segment", made.place.segment},
                   {"parameter", made.place.t},
                   {"position_mm", to_json(made.cut.position)},
                   {"direction", to_json(made.cut.direction)},
                   {"nodes", {made.cut.end[0], made.cut.end[1]}},
                   {"caps", {made.caps[0], made.caps[1]}},
                   {"cap_area_mm2", made.cap_area_mm2},
                   {"volumes_mm3", made.volumes_mm3}});
  return all;
}

Json CutPlan::clips_json() const {
  Json all = Json::array();
  for (const Clipped& clipped : clips_)
    all.push_back({{"element", clipped.clip.place.element},
                   {"time_s", clipped.clip.time_s},
                   {"closing_s", clipped.clip.closing_s},
                   {"segment", clipped.place.segment},
                   {"parameter", clipped.place.t},
                   {"position_mm", to_json(clipped.position)},
                   {"scale", clipped.clip.scale},
                   {"width_mm", clipped.width_mm}});
  return all;
}

}  // namespace vmesh::tool

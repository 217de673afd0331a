#include "vmesh/edit/crossing_guard.h"

#include <algorithm>
#include <bit>

#include "vmesh/mesh/face_plane.h"
#include "vmesh/mesh/topology.h"

namespace vmesh {
namespace {

// Each part has its own box: the box of a whole oblique axis would be mostly empty; idle 6 to 11.
constexpr Index kPartsOfLine = 8;
// Derived: relative rounding of an interpolated point, a few units in the last place.
constexpr double kRounding = 1e-15;
// Boxes that a search in a tree that has just been made looks at, for each of its levels and each face found; and
// boxes that searches may look at beyond that, for each face of the tree, before it is made anew, which takes about as
// long.
constexpr std::size_t kVisitsOfLevel = 2, kVisitsOfFace = 4, kVisitsInVain = 32;

const PlacedFace kNoFace{{kNone, kNone, kNone}, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}};

BoxTree::Box box_of(const std::array<Vec3, 3>& points) {
  const auto& [a, b, c] = points;
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

std::vector<BoxTree::Box> boxes_of(const std::vector<PlacedFace>& faces) {
  std::vector<BoxTree::Box> boxes;
  boxes.reserve(faces.size());
  for (const PlacedFace& face : faces) boxes.push_back(box_of(face.points));
  return boxes;
}

BoxTree::Box box_around(const std::vector<BoxTree::Box>& boxes) {
  BoxTree::Box around = boxes.front();
  for (const auto& [low, high] : boxes) around = {around.low.cwiseMin(low), around.high.cwiseMax(high)};
  return around;
}

BoxTree::Box box_of_part(const CrossingGuard::AxisLine& axis, Index number) {
  const auto& [from, to] = axis;
  const double t0 = double(number) / kPartsOfLine, t1 = double(number + 1) / kPartsOfLine;
  const Vec3 begin = (1 - t0) * from + t0 * to, end = (1 - t1) * from + t1 * to;
  const double rounding = kRounding * (from.cwiseAbs() + to.cwiseAbs()).maxCoeff();
  return {begin.cwiseMin(end).array() - rounding, begin.cwiseMax(end).array() + rounding};
}

bool cross_each_other(const std::vector<PlacedFace>& faces) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const FacePlane plane(faces[i]);
    for (std::size_t j = 0; j < i; ++j) {
      if (!plane.has_on_one_side(faces[j]) && intersect(faces[i], faces[j])) return true;
    }
  }
  return false;
}

}  // namespace

CrossingGuard::CrossingGuard(std::size_t faces, FaceLookup face_at, std::vector<AxisLine> axes)
    : face_at_(std::move(face_at)), axes_(std::move(axes)) {
  std::vector<Vec3> low, high;
  for (const AxisLine& axis : axes_) {
    for (Index i = 0; i < kPartsOfLine; ++i) {
      const BoxTree::Box box = box_of_part(axis, i);
      low.push_back(box.low);
      high.push_back(box.high);
    }
  }
  axis_tree_ = BoxTree(low, high);
  std::vector<ChangingBoxTree::Item> items;
  faces_.resize(faces, kNoFace);
  for (Index f = 0; f < faces; ++f) {
    faces_[f] = face_at_(f).value_or(kNoFace);
    if (has(f)) items.push_back({f, box_of(faces_[f].points)});
  }
  boxes_ = ChangingBoxTree(items);
}

void CrossingGuard::touch(Index f) {
  if (f >= faces_.size()) faces_.resize(f + std::size_t{1}, kNoFace);
  faces_[f] = face_at_(f).value_or(kNoFace);
  if (!has(f)) return;
  boxes_.set(f, box_of(faces_[f].points));
  if (visited_in_vain_ > kVisitsInVain * boxes_.size()) make_anew();
}

void CrossingGuard::note_search(std::size_t visited, std::size_t found) const {
  const std::size_t levels = std::bit_width(boxes_.size());
  visited_in_vain_ += visited - std::min(visited, kVisitsOfLevel * levels + kVisitsOfFace * found);
}

// Without the faces that have been removed.
void CrossingGuard::make_anew() {
  std::vector<ChangingBoxTree::Item> items;
  boxes_.visit([&](Index f, const BoxTree::Box& box) {
    if (has(f)) items.push_back({f, box});
  });
  boxes_ = ChangingBoxTree(items);
  visited_in_vain_ = 0;
}

bool CrossingGuard::allows(const std::vector<PlacedFace>& faces, const std::vector<Index>& gone) const {
  const auto refuse = [](Index& count) {
    ++count;
    return false;
  };
  if (std::any_of(faces.begin(), faces.end(), is_degenerate)) return refuse(refused_.degenerate);
  if (cross_each_other(faces)) return refuse(refused_.crossing);
  if (cross_axes(faces, gone)) return refuse(refused_.axis);
  if (cross_others(faces, gone)) return refuse(refused_.crossing);
  return true;
}

bool CrossingGuard::cross_axes(const std::vector<PlacedFace>& faces, const std::vector<Index>& gone) const {
  const auto meets = [&](const PlacedFace& face, Index axis) {
    return meets_segment(face, axes_[axis][0], axes_[axis][1]);
  };
  const auto was_met = [&](Index axis) {
    return std::any_of(gone.begin(), gone.end(), [&](Index f) {
      return f < faces_.size() && has(f) && !is_degenerate(faces_[f]) && meets(faces_[f], axis);
    });
  };
  if (faces.empty()) return false;
  const std::vector<BoxTree::Box> boxes = boxes_of(faces);
  const BoxTree::Box around = box_around(boxes);
  return axis_tree_.any_overlapping(around.low, around.high, [&](Index number) {
    const Index axis = number / kPartsOfLine;
    const BoxTree::Box part = box_of_part(axes_[axis], number % kPartsOfLine);
    if (!part.overlaps(around.low, around.high)) return false;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (part.overlaps(boxes[i].low, boxes[i].high) && meets(faces[i], axis) && !was_met(axis)) return true;
    }
    return false;
  });
}

bool CrossingGuard::cross_others(const std::vector<PlacedFace>& faces, const std::vector<Index>& gone) const {
  if (faces.empty()) return false;
  const std::vector<BoxTree::Box> boxes = boxes_of(faces);
  const BoxTree::Box around = box_around(boxes);
  const std::vector<FacePlane> planes(faces.begin(), faces.end());
  std::size_t visited = 0, found = 0;
  const bool cross = boxes_.any_overlapping(around.low, around.high, visited, [&](Index f, const BoxTree::Box& box) {
    const auto is_near = [&](const BoxTree::Box& own) { return own.overlaps(box.low, box.high); };
    const auto first = std::find_if(boxes.begin(), boxes.end(), is_near);
    if (first == boxes.end()) return false;
    if (!has(f)) return false;
    ++found;
    if (std::find(gone.begin(), gone.end(), f) != gone.end()) return false;
    const PlacedFace& other = faces_[f];
    for (auto own = first; own != boxes.end(); ++own) {
      const auto i = static_cast<std::size_t>(own - boxes.begin());
      if (is_near(*own) && !planes[i].has_on_one_side(other) && !is_degenerate(other) && intersect(faces[i], other))
        return true;
    }
    return false;
  });
  note_search(visited, found);
  return cross;
}

std::vector<std::pair<Index, Index>> crossing_pairs(const std::vector<Vec3>& positions,
                                                    const std::vector<Triangle>& faces,
                                                    const std::vector<Index>& changed) {
  const auto box = [&](Index f) {
    const auto& [a, b, c] = faces[f];
    return box_of({positions[a], positions[b], positions[c]});
  };
  std::vector<Vec3> low, high;
  for (const Index f : changed) {
    low.push_back(box(f).low);
    high.push_back(box(f).high);
  }
  const BoxTree tree(low, high);
  TriMesh near;
  std::vector<Index> face_of, number(positions.size(), kNone);
  for (Index f = 0; f < faces.size(); ++f) {
    Triangle face = faces[f];
    if (face[0] == kNone) continue;
    bool meets = false;
    tree.visit_overlapping(box(f).low, box(f).high, [&](Index) { meets = true; });
    if (!meets) continue;
    for (Index& v : face) {
      if (number[v] == kNone) {
        number[v] = static_cast<Index>(near.vertices.size());
        near.vertices.push_back(positions[v]);
      }
      v = number[v];
    }
    near.faces.push_back(face);
    face_of.push_back(f);
  }
  std::vector<std::pair<Index, Index>> crossing = self_intersections(near);
  for (auto& [f, g] : crossing) f = face_of[f], g = face_of[g];
  return crossing;
}

}  // namespace vmesh

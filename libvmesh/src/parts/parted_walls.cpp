// Parting walls of pieces that cross each other, with only the parts nearby in memory.
#include <algorithm>
#include <unordered_map>

#include "vmesh/core/ascending.h"
#include "vmesh/core/error.h"

#include "parts/part_index.h"

namespace vmesh {
namespace {

class WallParting {
 public:
  WallParting(const PartIndex& index, const std::vector<std::pair<Index, Index>>& crossings)
      : index_(index), crossings_(crossings) {}

  PartedWalls run() {
    for (const std::size_t p : parts_near()) load(p);
    SurfaceAround around = surface_;
    std::vector<std::pair<Index, Index>> local;
    for (const auto& [f, g] : crossings_) local.emplace_back(place_in(face_, f), place_in(face_, g));
    std::vector<FieldExcerpt> excerpts;
    for (const StoredPart& part : parts_) excerpts.push_back(part.part.field);
    for (const auto& [f, g] : part_walls(around, merged(excerpts), local))
      result_.left.emplace_back(face_[f], face_[g]);
    compare(around);
    return std::move(result_);
  }

 private:
  // All parts that may have faces near a pair: one step does not reach beyond the pieces of its faces and those next to
  // them.
  std::vector<std::size_t> parts_near() const {
    std::vector<PieceBox> hulls;
    for (const auto& [f, g] : crossings_) {
      PieceBox hull = index_.boxes[index_.piece_of_face(f)];
      hull.add(index_.boxes[index_.piece_of_face(g)]);
      hulls.push_back(hull);
    }
    std::vector<std::size_t> parts;
    for (std::size_t piece = 0; piece < index_.boxes.size(); ++piece) {
      const bool near = std::any_of(hulls.begin(), hulls.end(),
                                    [&](const PieceBox& hull) { return hull.meets(index_.boxes[piece]); });
      if (near) parts.push_back(index_.part_of_piece(piece));
    }
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    return parts;
  }

  void load(std::size_t p) {
    parts_.push_back(read_part(index_.parts[p].part));
    if (parts_.back().id != index_.manifest.id)
      throw InvalidInput(index_.parts[p].part.string() + ": is of another splitting than " + kManifestName);
    const StoredPartSurface stored = read_part_surface(index_.parts[p].surface, false);
    const PartSurface& surface = stored.surface;
    for (Index f = 0; f < surface.mesh.faces.size(); ++f) {
      Triangle corners = surface.mesh.faces[f];
      for (Index& v : corners) v = number_of(index_.vertex(p, surface, v), surface, v);
      surface_.mesh.faces.push_back(corners);
      face_.push_back(index_.parts[p].first_face + f);
    }
  }

  Index number_of(Index in_whole, const PartSurface& surface, Index v) {
    const auto [it, is_new] = number_.emplace(in_whole, static_cast<Index>(vertex_.size()));
    if (is_new) {
      vertex_.push_back(in_whole);
      surface_.mesh.vertices.push_back(surface.mesh.vertices[v]);
      surface_.binding.push_back(surface.binding[v]);
      surface_.radius.push_back(surface.radius[v]);
    }
    return it->second;
  }

  PartedWalls::Vertex vertex_of(const SurfaceAround& after, Index v, Index number) const {
    const CenterlineBinding& binding = after.binding[v];
    for (const StoredPart& part : parts_) {
      const Index cone = place_in(part.part.field.cone, binding.segment);
      if (cone == kNone) continue;
      return {number,
              after.mesh.vertices[v],
              binding,
              after.radius[v],
              part.origins.original(cone, binding.t),
              part.origins.branch[cone]};
    }
    throw InvalidInput("parts of a surface do not belong together");
  }

  // Positions and bindings change together, so comparing positions is enough.
  void compare(const SurfaceAround& after) {
    const auto whole = static_cast<Index>(index_.vertices);
    for (Index v = 0; v < after.mesh.vertices.size(); ++v) {
      if (v >= vertex_.size()) {
        result_.added.push_back(vertex_of(after, v, whole + v - static_cast<Index>(vertex_.size())));
      } else if (after.mesh.vertices[v] != surface_.mesh.vertices[v]) {
        result_.moved.push_back(vertex_of(after, v, vertex_[v]));
      }
    }
    std::sort(result_.moved.begin(), result_.moved.end(),
              [](const auto& a, const auto& b) { return a.number < b.number; });
    for (Index f = 0; f < after.mesh.faces.size(); ++f) {
      Triangle corners = after.mesh.faces[f];
      if (f < face_.size() && corners == surface_.mesh.faces[f]) continue;
      for (Index& v : corners) v = v < vertex_.size() ? vertex_[v] : whole + v - static_cast<Index>(vertex_.size());
      if (f < face_.size()) {
        result_.changed.emplace_back(face_[f], corners);
      } else {
        result_.added_faces.push_back(corners);
      }
    }
  }

  const PartIndex& index_;
  const std::vector<std::pair<Index, Index>>& crossings_;
  std::vector<StoredPart> parts_;
  SurfaceAround surface_;
  std::vector<Index> vertex_, face_;  // in the whole
  std::unordered_map<Index, Index> number_;
  PartedWalls result_;
};

}  // namespace

PartedWalls part_crossing_walls(const PartIndex& index, const std::vector<std::pair<Index, Index>>& crossings) {
  return WallParting(index, crossings).run();
}

}  // namespace vmesh

#include "surface/pieces/gathering.h"

#include <algorithm>

namespace vmesh {
namespace {

class Gatherer {
 public:
  Gatherer(const VesselRings& tubes, const Division& division) : tubes_(tubes), division_(division) {}

  GatheredSurface run(const std::vector<PieceSurface>& pieces) {
    reserve(pieces);
    add_seams();
    for (const PieceSurface& piece : pieces) add(piece);
    surface_.first_face.push_back(static_cast<Index>(surface_.mesh.faces.size()));
    return std::move(surface_);
  }

 private:
  const Ring& ring_at(const RingPlace& seam) const { return tubes_.rings(seam.branch)[seam.ring]; }

  void reserve(const std::vector<PieceSurface>& pieces) {
    std::size_t vertices = 0, faces = 0;
    for (const RingPlace& seam : division_.seams) vertices += ring_at(seam).points.size();
    for (const PieceSurface& piece : pieces) {
      vertices += piece.vertices.size();
      faces += piece.faces.size();
    }
    surface_.mesh.vertices.reserve(vertices);
    surface_.binding.reserve(vertices);
    surface_.radius.reserve(vertices);
    surface_.mesh.faces.reserve(faces);
  }

  void add_seams() {
    const VesselField& field = tubes_.field();
    for (const RingPlace& seam : division_.seams) {
      seam_begin_.push_back(static_cast<Index>(surface_.mesh.vertices.size()));
      for (const BoundaryPoint& p : tubes_.layer().lifted(ring_at(seam))) {
        const FieldSample sample = field.sample_fast(p.position, p.sample.cone);
        surface_.mesh.vertices.push_back(p.position);
        surface_.binding.push_back({sample.cone, sample.t});
        surface_.radius.push_back(field.relations().radius_at(sample.cone, sample.t));
      }
    }
  }

  Index number_of(const SeamVertex& v) const {
    const auto seam = std::lower_bound(division_.seams.begin(), division_.seams.end(), v.seam);
    return seam_begin_[static_cast<std::size_t>(seam - division_.seams.begin())] + v.number;
  }

  void add(const PieceSurface& piece) {
    surface_.first_face.push_back(static_cast<Index>(surface_.mesh.faces.size()));
    const auto begin = static_cast<Index>(surface_.mesh.vertices.size());
    const auto own = static_cast<Index>(piece.vertices.size());
    const auto number = [&](Index v) { return v < own ? begin + v : number_of(piece.seam_vertices[v - own]); };
    TriMesh& mesh = surface_.mesh;
    mesh.vertices.insert(mesh.vertices.end(), piece.vertices.begin(), piece.vertices.end());
    surface_.binding.insert(surface_.binding.end(), piece.binding.begin(), piece.binding.end());
    surface_.radius.insert(surface_.radius.end(), piece.radius.begin(), piece.radius.end());
    for (const auto& [a, b, c] : piece.faces) mesh.faces.push_back({number(a), number(b), number(c)});
    for (const PieceSurface::Hole& hole : piece.holes) {
      const CenterlineNode& node = tubes_.centerline().node(hole.node);
      Opening opening{hole.node, node.position, Vec3::Zero(), node.radius, {}};
      for (const Index v : hole.vertices) opening.ring.push_back(number(v));
      surface_.openings.push_back(std::move(opening));
    }
  }

  const VesselRings& tubes_;
  const Division& division_;
  std::vector<Index> seam_begin_;
  GatheredSurface surface_;
};

}  // namespace

Index GatheredSurface::piece_of(Index face) const {
  return static_cast<Index>(std::upper_bound(first_face.begin(), first_face.end(), face) - first_face.begin() - 1);
}

GatheredSurface gather(const VesselRings& tubes, const Division& division, const std::vector<PieceSurface>& pieces) {
  return Gatherer(tubes, division).run(pieces);
}

}  // namespace vmesh

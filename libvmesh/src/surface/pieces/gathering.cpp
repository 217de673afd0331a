#include "surface/pieces/gathering.h"

#include <algorithm>

#include "vmesh/core/memory.h"

namespace vmesh {
namespace {

// Room beyond the expected number of vertices: no memory is used unless it is filled.
constexpr double kRoom = 1.2;
// Freed memory is returned this often, but not for less than so many vertices.
constexpr std::size_t kReleases = 16, kLeastRelease = 1 << 16;

// The number of a seam in a division; kNone if it has been dissolved.
Index seam_number(const RingPlace& seam, const Division& division) {
  const auto it = std::lower_bound(division.seams.begin(), division.seams.end(), seam);
  return it != division.seams.end() && *it == seam ? static_cast<Index>(it - division.seams.begin()) : kNone;
}

template <class T>
void append_and_free(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
  std::vector<T>().swap(from);
}

/// Numbers the vertices of a piece as they are in the whole surface.
class PieceNumbers {
 public:
  /// `begin`, `own`: the first of its own vertices and their number. All seams have `around` vertices.
  PieceNumbers(const PieceSurface& piece, const Division& division, Index around, Index begin, Index own)
      : piece_(piece), division_(division), around_(around), begin_(begin), own_(own) {}

  Index operator()(Index v) const {
    if (v < own_) return begin_ + v;
    const SeamVertex& at = piece_.seam_vertices[v - own_];
    return seam_number(at.seam, division_) * around_ + at.number;
  }
  Triangle operator()(const Triangle& f) const { return {(*this)(f[0]), (*this)(f[1]), (*this)(f[2])}; }

 private:
  const PieceSurface& piece_;
  const Division& division_;
  Index around_, begin_, own_;
};

void add_openings(const PieceSurface& piece, const PieceNumbers& number, const Centerline& centerline,
                  std::vector<Opening>& openings) {
  for (const PieceSurface::Hole& hole : piece.holes) {
    const CenterlineNode& node = centerline.node(hole.node);
    Opening opening{hole.node, node.position, Vec3::Zero(), node.radius, {}};
    for (const Index v : hole.vertices) opening.ring.push_back(number(v));
    openings.push_back(std::move(opening));
  }
}

class Regatherer {
 public:
  Regatherer(GatheredSurface surface, const Division& before, const Division& division, const std::vector<Index>& known,
             std::vector<PieceSurface>& pieces)
      : surface_(std::move(surface)), before_(before), division_(division), known_(known), pieces_(pieces) {
    const std::size_t seams = before.seams.size();
    around_ = seams > 0 ? static_cast<Index>(surface_.first_vertex.front() / seams) : 0;
  }

  // Column by column, so that little is in memory twice.
  GatheredSurface run(const Centerline& centerline) {
    number_pieces();
    merge(surface_.mesh.vertices, &PieceSurface::vertices);
    merge(surface_.binding, &PieceSurface::binding);
    merge(surface_.radius, &PieceSurface::radius);
    merge_faces();
    surface_.openings.clear();
    for (Index p = 0; p < pieces_.size(); ++p) add_openings(pieces_[p], numbers_in(p), centerline, surface_.openings);
    surface_.first_vertex = std::move(first_vertex_);
    surface_.first_face = std::move(first_face_);
    return std::move(surface_);
  }

 private:
  void number_pieces() {
    first_vertex_ = {static_cast<Index>(division_.seams.size()) * around_};
    first_face_ = {0};
    for (Index p = 0; p < known_.size(); ++p) {
      const Index q = known_[p];
      const std::size_t vertices =
          q == kNone ? pieces_[p].vertices.size() : surface_.first_vertex[q + 1] - surface_.first_vertex[q];
      const std::size_t faces =
          q == kNone ? pieces_[p].faces.size() : surface_.first_face[q + 1] - surface_.first_face[q];
      first_vertex_.push_back(first_vertex_.back() + static_cast<Index>(vertices));
      first_face_.push_back(first_face_.back() + static_cast<Index>(faces));
    }
  }

  template <class T>
  void merge(std::vector<T>& column, std::vector<T> PieceSurface::*own) {
    std::vector<T> merged;
    merged.reserve(first_vertex_.back());
    const auto copy = [&](Index begin, Index end) {
      merged.insert(merged.end(), column.begin() + begin, column.begin() + end);
    };
    for (const RingPlace& seam : division_.seams) {
      const Index begin = seam_number(seam, before_) * around_;
      copy(begin, begin + around_);
    }
    for (Index p = 0; p < known_.size(); ++p) {
      if (known_[p] == kNone) {
        append_and_free(pieces_[p].*own, merged);
      } else {
        copy(surface_.first_vertex[known_[p]], surface_.first_vertex[known_[p] + 1]);
      }
    }
    column = std::move(merged);
  }

  void merge_faces() {
    std::vector<Triangle> merged;
    merged.reserve(first_face_.back());
    for (Index p = 0; p < known_.size(); ++p) {
      if (known_[p] == kNone) {
        const PieceNumbers number = numbers_in(p);
        for (const Triangle& face : pieces_[p].faces) merged.push_back(number(face));
        std::vector<Triangle>().swap(pieces_[p].faces);
      } else {
        const Index q = known_[p];
        for (Index f = surface_.first_face[q]; f < surface_.first_face[q + 1]; ++f)
          merged.push_back(renumbered(surface_.mesh.faces[f], p));
      }
    }
    surface_.mesh.faces = std::move(merged);
  }

  // A face of a known piece: it refers to its own vertices and to those of its seams, which are still there.
  Triangle renumbered(Triangle face, Index p) const {
    for (Index& v : face) {
      if (v >= surface_.first_vertex.front()) {
        v = v - surface_.first_vertex[known_[p]] + first_vertex_[p];
      } else {
        v = seam_number(before_.seams[v / around_], division_) * around_ + v % around_;
      }
    }
    return face;
  }

  PieceNumbers numbers_in(Index p) const {
    return {pieces_[p], division_, around_, first_vertex_[p], first_vertex_[p + 1] - first_vertex_[p]};
  }

  GatheredSurface surface_;
  const Division &before_, &division_;
  const std::vector<Index>& known_;
  std::vector<PieceSurface>& pieces_;
  Index around_ = 0;
  std::vector<Index> first_vertex_, first_face_;
};

}  // namespace

Index GatheredSurface::piece_of(Index face) const {
  return static_cast<Index>(std::upper_bound(first_face.begin(), first_face.end(), face) - first_face.begin() - 1);
}

Gatherer::Gatherer(const VesselRings& tubes, const Division& division, std::vector<PieceSurface>& pieces,
                   double vertices)
    : tubes_(tubes), division_(division), pieces_(pieces), finished_(division.plans.size(), 0) {
  const auto expected = static_cast<std::size_t>(kRoom * vertices);
  surface_.mesh.vertices.reserve(expected);
  surface_.binding.reserve(expected);
  surface_.radius.reserve(expected);
  surface_.mesh.faces.reserve(2 * expected);
  release_at_ = release_step_ = std::max(kLeastRelease, expected / kReleases);
  add_seams();
}

void Gatherer::add_seams() {
  const VesselField& field = tubes_.field();
  for (const auto& [branch, ring] : division_.seams) {
    const std::vector<RingPoint> points = tubes_.layer().lifted(branch, tubes_.rings(branch)[ring]);
    around_ = static_cast<Index>(points.size());
    for (const RingPoint& p : points) {
      const FieldSample sample = field.sample_fast(p.position, p.cone);
      surface_.mesh.vertices.push_back(p.position);
      surface_.binding.push_back({sample.cone, sample.t});
      surface_.radius.push_back(field.relations().radius_at(sample.cone, sample.t));
    }
  }
}

void Gatherer::add(Index piece) {
  const std::lock_guard lock(adding_);
  finished_[piece] = 1;
  for (; next_ < finished_.size() && finished_[next_]; ++next_) append(pieces_[next_]);
  if (surface_.mesh.vertices.size() < release_at_) return;
  release_at_ = surface_.mesh.vertices.size() + release_step_;
  release_freed_memory();
}

void Gatherer::append(PieceSurface& piece) {
  const auto begin = static_cast<Index>(surface_.mesh.vertices.size());
  const PieceNumbers number(piece, division_, around_, begin, static_cast<Index>(piece.vertices.size()));
  surface_.first_vertex.push_back(begin);
  surface_.first_face.push_back(static_cast<Index>(surface_.mesh.faces.size()));
  for (const Triangle& face : piece.faces) surface_.mesh.faces.push_back(number(face));
  add_openings(piece, number, tubes_.centerline(), surface_.openings);
  append_and_free(piece.vertices, surface_.mesh.vertices);
  append_and_free(piece.binding, surface_.binding);
  append_and_free(piece.radius, surface_.radius);
  std::vector<Triangle>().swap(piece.faces);
  if (piece.holes.empty()) std::vector<SeamVertex>().swap(piece.seam_vertices);
}

GatheredSurface Gatherer::finish() {
  surface_.first_vertex.push_back(static_cast<Index>(surface_.mesh.vertices.size()));
  surface_.first_face.push_back(static_cast<Index>(surface_.mesh.faces.size()));
  return std::move(surface_);
}

GatheredSurface gather(const VesselRings& tubes, const Division& division, std::vector<PieceSurface> pieces) {
  double vertices = 0;
  for (const PieceSurface& piece : pieces) vertices += static_cast<double>(piece.vertices.size());
  Gatherer gatherer(tubes, division, pieces, vertices);
  for (Index p = 0; p < pieces.size(); ++p) gatherer.add(p);
  return gatherer.finish();
}

GatheredSurface gather_again(GatheredSurface surface, const Division& before, const Division& division,
                             const std::vector<Index>& known, std::vector<PieceSurface>& pieces,
                             const Centerline& centerline) {
  return Regatherer(std::move(surface), before, division, known, pieces).run(centerline);
}

}  // namespace vmesh

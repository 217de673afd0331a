#include "parts/part_index.h"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "vmesh/core/ascending.h"
#include "vmesh/core/box_tree.h"
#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"

namespace vmesh {
namespace {

class Indexer {
 public:
  Indexer(const std::filesystem::path& folder, const Progress& progress) : folder_(folder), progress_(progress) {}

  PartIndex run() {
    index_.manifest = read_manifest(folder_ / kManifestName);
    const PartsManifest& manifest = index_.manifest;
    index_.growth.rungs.assign(kRungs, 0);
    vertex_ = manifest.seams * manifest.around;
    seen_.assign(manifest.seams, 0);
    index_.first_face = {0};
    for (std::size_t p = 0; p < manifest.parts; ++p) {
      report_progress(progress_, "index", static_cast<double>(p) / static_cast<double>(manifest.parts));
      add(p);
    }
    if (index_.boxes.size() != manifest.pieces || std::count(seen_.begin(), seen_.end(), 2) != std::ssize(seen_))
      throw InvalidInput(folder_.string() + ": the parts are not the whole; split it again");
    index_.vertices = vertex_;
    index_.faces = index_.first_face.back();
    finish_growth();
    return std::move(index_);
  }

 private:
  void add(std::size_t p) {
    PartIndex::Entry entry;
    entry.part = folder_ / (part_name(p) + kPartExtension);
    entry.surface = folder_ / (part_name(p) + kPartSurfaceExtension);
    if (!std::filesystem::exists(entry.surface))
      throw ReadError(entry.surface.string() + ": is missing; make it with: vmesh generate " + entry.part.string());
    const StoredPartSurface stored = read_part_surface(entry.surface);
    const PartSurface& surface = stored.surface;
    if (stored.id != index_.manifest.id || surface.around != index_.manifest.around ||
        surface.first_piece != index_.boxes.size())
      throw InvalidInput(entry.surface.string() + ": is of another splitting than " + std::string(kManifestName) +
                         "; generate it again");
    entry.first_vertex = static_cast<Index>(vertex_);
    entry.first_face = index_.first_face.back();
    entry.first_piece = index_.boxes.size();
    for (const Index seam : surface.seams) {
      if (seam >= seen_.size() || seen_[seam] == 2)
        throw InvalidInput(entry.surface.string() + ": is damaged: its seams are not those of the whole");
    }
    add_pieces(surface);
    for (const auto& [f, g] : surface.crossings)
      index_.crossings.emplace_back(entry.first_face + f, entry.first_face + g);
    vertex_ += surface.mesh.vertices.size() - surface.seam_vertex_count();
    if (vertex_ > 0xffffffff || index_.first_face.back() + surface.mesh.faces.size() > 0xffffffff)
      throw Unsupported(folder_.string() + ": the whole has more vertices or faces than can be numbered (2^32)");
    index_.parts.push_back(std::move(entry));
  }

  void add_pieces(const PartSurface& surface) {
    Index face = 0;
    for (const PartSurface::Piece& piece : surface.pieces) {
      PieceBox box;
      std::vector<Index> seams;
      for (const Index end = face + piece.face_count; face < end; ++face) {
        for (const Index v : surface.mesh.faces[face]) {
          box.add(surface.mesh.vertices[v]);
          if (v < surface.seam_vertex_count()) seams.push_back(surface.seams[v / surface.around]);
        }
      }
      sort_unique(seams);
      for (const Index seam : seams) ++seen_[seam];
      index_.boxes.push_back(box);
      index_.first_face.push_back(index_.first_face.back() + piece.face_count);
      GrowthSummary& growth = index_.growth;
      growth.junctions += piece.junctions;
      growth.tubes += piece.tubes;
      filled_ += piece.filled_loops;
      ++growth.rungs[piece.rung];
      growth.refused += piece.refused;
    }
    for (const GrowthSimplification& note : surface.simplifications) index_.growth.simplifications.push_back(note);
  }

  void finish_growth() {
    GrowthSummary& growth = index_.growth;
    growth.pieces = index_.boxes.size();
    growth.tubes -= index_.manifest.seams;  // the tubes on both sides of a seam count as one
    growth.components = index_.manifest.components;
    growth.cycle_rank = index_.manifest.cycle_rank - filled_;
    const std::vector<GrowthSimplification>& left_out = index_.manifest.simplifications;
    growth.simplifications.insert(growth.simplifications.end(), left_out.begin(), left_out.end());
  }

  const std::filesystem::path& folder_;
  const Progress& progress_;
  PartIndex index_;
  std::size_t vertex_ = 0, filled_ = 0;
  std::vector<char> seen_;  // of seams: pieces that have them
};

// Some pieces of two parts, with the numbers of their faces in the whole.
class PiecesOfTwo {
 public:
  explicit PiecesOfTwo(const PartIndex& index) : index_(index) {}

  void add(std::size_t part, const PartSurface& surface, const std::vector<std::size_t>& pieces) {
    first_face_.push_back(static_cast<Index>(mesh_.faces.size()));
    for (const std::size_t piece : pieces) {
      for (Index f = index_.first_face[piece]; f < index_.first_face[piece + 1]; ++f) {
        Triangle corners = surface.mesh.faces[f - index_.parts[part].first_face];
        for (Index& v : corners) v = number_of(index_.vertex(part, surface, v), surface.mesh.vertices[v]);
        mesh_.faces.push_back(corners);
        face_.push_back(f);
      }
    }
  }

  void find(std::vector<std::pair<Index, Index>>& crossings) {
    first_face_.push_back(static_cast<Index>(mesh_.faces.size()));
    for (const auto& [f, g] : intersections_between(mesh_, first_face_))
      crossings.push_back(std::minmax(face_[f], face_[g]));
  }

 private:
  Index number_of(Index in_whole, const Vec3& position) {
    const auto [it, is_new] = number_.emplace(in_whole, static_cast<Index>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(position);
    return it->second;
  }

  const PartIndex& index_;
  TriMesh mesh_;
  std::vector<Index> face_, first_face_;
  std::unordered_map<Index, Index> number_;
};

}  // namespace

std::size_t PartIndex::piece_of_face(Index face) const {
  return static_cast<std::size_t>(std::upper_bound(first_face.begin(), first_face.end(), face) - first_face.begin() -
                                  1);
}

std::size_t PartIndex::part_of_piece(std::size_t piece) const {
  const auto it = std::upper_bound(parts.begin(), parts.end(), piece,
                                   [](std::size_t p, const Entry& entry) { return p < entry.first_piece; });
  return static_cast<std::size_t>(it - parts.begin() - 1);
}

PartIndex index_parts(const std::filesystem::path& folder, const Progress& progress) {
  return Indexer(folder, progress).run();
}

std::vector<std::pair<Index, Index>> crossings_between_parts(const PartIndex& index, const Progress& progress) {
  std::vector<Vec3> low, high;
  for (const PieceBox& box : index.boxes) {
    low.push_back(box.low);
    high.push_back(box.high);
  }
  // Pieces of every two parts that are near each other.
  std::map<std::pair<std::size_t, std::size_t>, std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> near;
  BoxTree(low, high).visit_pairs([&](Index p, Index q) {
    const auto [first, second] = std::minmax(p, q);
    const std::size_t a = index.part_of_piece(first), b = index.part_of_piece(second);
    if (a == b || !index.boxes[first].meets(index.boxes[second])) return;
    near[{a, b}].first.push_back(first);
    near[{a, b}].second.push_back(second);
  });
  std::vector<std::pair<Index, Index>> crossings;
  StoredPartSurface first;
  std::size_t loaded = index.parts.size(), done = 0;
  for (auto& [parts, pieces] : near) {
    report_progress(progress, "compare", static_cast<double>(done++) / static_cast<double>(near.size()));
    const auto [a, b] = parts;
    sort_unique(pieces.first);
    sort_unique(pieces.second);
    if (loaded != a) first = read_part_surface(index.parts[a].surface, false);
    loaded = a;
    const StoredPartSurface second = read_part_surface(index.parts[b].surface, false);
    PiecesOfTwo both(index);
    both.add(a, first.surface, pieces.first);
    both.add(b, second.surface, pieces.second);
    both.find(crossings);
  }
  std::sort(crossings.begin(), crossings.end());
  return crossings;
}

}  // namespace vmesh

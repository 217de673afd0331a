// Growing a part of a surface.
#include <algorithm>
#include <atomic>

#include <tbb/task_arena.h>

#include "vmesh/core/ascending.h"
#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/part.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/pieces/parting.h"
#include "surface/pieces/piece.h"
#include "surface/pieces/whole_tasks.h"

namespace vmesh {
namespace {

void require(bool holds, const char* what) {
  if (!holds) throw InvalidInput(std::string("a part of a surface is inconsistent: ") + what);
}

void check_branches(const SurfacePart& part) {
  const auto is_node = [&](Index n) { return n < part.field.nodes.size(); };
  for (const Branch& branch : part.branches) {
    require(!branch.segments.empty() && branch.nodes.size() == branch.segments.size() + 1, "its branches");
    require(std::all_of(branch.nodes.begin(), branch.nodes.end(), is_node), "the nodes of its branches");
    for (std::size_t i = 0; i < branch.segments.size(); ++i) {
      require(branch.segments[i] < part.field.segments.size(), "the segments of its branches");
      const auto [a, b] = part.field.segments[branch.segments[i]];
      require(std::minmax(a, b) == std::minmax(branch.nodes[i], branch.nodes[i + 1]), "the order of its branches");
    }
  }
}

void check_places(const SurfacePart& part, const VesselRings& tubes) {
  const auto rings = [&](Index branch) {
    require(branch < tubes.axes().size(), "the branches of its pieces");
    return tubes.rings(branch).size();
  };
  for (const PiecePlan& plan : part.pieces) {
    for (const Index n : plan.nodes) require(n < part.field.nodes.size(), "the nodes of its pieces");
    for (const Stretch& s : plan.stretches)
      require(s.first < rings(s.branch) && s.count >= 1 && s.count <= rings(s.branch) + 1, "the rings of its pieces");
  }
  for (const SurfacePart::Seam& seam : part.seams)
    require(seam.place.ring < rings(seam.place.branch) && tubes.rings(seam.place.branch)[seam.place.ring].free,
            "its seams");
  require(std::is_sorted(part.seams.begin(), part.seams.end(),
                         [](const auto& a, const auto& b) { return a.place < b.place && a.number < b.number; }),
          "the order of its seams");
}

class PartGrower {
 public:
  PartGrower(const SurfacePart& part, const VesselField& field)
      : part_(part), tubes_(field, RingOptions::of(part.options), part.branches), open_(part.field.nodes.size(), 0) {
    check_places(part, tubes_);
  }

  PartSurface run(const Progress& progress) {
    std::vector<PieceSurface> pieces(part_.pieces.size());
    std::atomic<std::size_t> done{0};
    const Progress ask = [&](std::string_view, double) {
      return !progress || progress("grow", static_cast<double>(done) / static_cast<double>(pieces.size()));
    };
    const PieceContext context{tubes_, open_, part_.options, ask};
    for_whole_tasks(pieces.size(), [&](std::size_t p) {
      report_progress(ask, "grow", 0);
      pieces[p] = make_piece(context, part_.pieces[p]);
      ++done;
    });
    result_.first_piece = part_.first_piece;
    result_.around = static_cast<Index>(part_.options.around);
    add_seams();
    std::vector<Index> first_face;
    for (PieceSurface& piece : pieces) {
      first_face.push_back(static_cast<Index>(result_.mesh.faces.size()));
      add(piece);
      piece = {};
    }
    first_face.push_back(static_cast<Index>(result_.mesh.faces.size()));
    result_.crossings = intersections_between(result_.mesh, first_face);
    return std::move(result_);
  }

 private:
  void add_vertex(const Vec3& position, const CenterlineBinding& binding, double radius) {
    result_.mesh.vertices.push_back(position);
    result_.binding.push_back({part_.field.cone[binding.segment], binding.t});
    result_.radius.push_back(radius);
  }

  void add_seams() {
    const VesselField& field = tubes_.field();
    for (const SurfacePart::Seam& seam : part_.seams) {
      result_.seams.push_back(seam.number);
      const auto [branch, ring] = seam.place;
      for (const RingPoint& p : tubes_.layer().lifted(branch, tubes_.rings(branch)[ring])) {
        const FieldSample sample = field.sample_fast(p.position, p.cone);
        add_vertex(p.position, {sample.cone, sample.t}, field.relations().radius_at(sample.cone, sample.t));
      }
    }
  }

  Index number_of(const SeamVertex& v) const {
    const auto it =
        std::lower_bound(part_.seams.begin(), part_.seams.end(), v.seam,
                         [](const SurfacePart::Seam& s, const RingPlace& place) { return s.place < place; });
    if (it == part_.seams.end() || it->place != v.seam) require(false, "its seams");
    return static_cast<Index>(it - part_.seams.begin()) * result_.around + v.number;
  }

  void add(const PieceSurface& piece) {
    const auto begin = static_cast<Index>(result_.mesh.vertices.size());
    const auto own = static_cast<Index>(piece.vertices.size());
    for (Index v = 0; v < own; ++v) add_vertex(piece.vertices[v], piece.binding[v], piece.radius[v]);
    const auto number = [&](Index v) { return v < own ? begin + v : number_of(piece.seam_vertices[v - own]); };
    for (const auto& [a, b, c] : piece.faces) result_.mesh.faces.push_back({number(a), number(b), number(c)});
    result_.pieces.push_back({own, static_cast<Index>(piece.faces.size()), static_cast<Index>(piece.junctions),
                              static_cast<Index>(piece.tubes), static_cast<Index>(piece.filled_loops),
                              static_cast<Index>(piece.rung), piece.refused, piece.worst_skewness, piece.faults});
    for (GrowthSimplification note : piece.simplifications) {
      for (Index& n : note.nodes) n = part_.field.node[n];
      for (Index& s : note.segments) s = part_.field.cone[s];
      result_.simplifications.push_back(std::move(note));
    }
  }

  const SurfacePart& part_;
  VesselRings tubes_;
  std::vector<char> open_;
  PartSurface result_;
};

}  // namespace

PartSurface grow_part(const SurfacePart& part, int threads, const Progress& progress) {
  require(!part.pieces.empty(), "it has no pieces");
  check_branches(part);
  const Centerline centerline = part.field.centerline();
  const VesselField field(centerline, part.field);
  PartSurface surface;
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] { surface = PartGrower(part, field).run(progress); });
  return surface;
}

std::vector<std::pair<Index, Index>> part_walls(SurfaceAround& surface, const FieldExcerpt& excerpt,
                                                const std::vector<std::pair<Index, Index>>& crossings) {
  const Centerline centerline = excerpt.centerline();
  const VesselField field(centerline, excerpt);
  const auto place_of = [&](Index cone) {
    const Index place = place_in(excerpt.cone, cone);
    if (place == kNone) throw InvalidInput("the parts do not belong to this surface");
    return place;
  };
  GatheredSurface gathered{
      {std::move(surface.mesh), std::move(surface.binding), std::move(surface.radius), {}, {}}, {}, {}};
  for (CenterlineBinding& binding : gathered.binding) binding.segment = place_of(binding.segment);
  std::vector<std::pair<Index, Index>> left = part_walls(gathered, field, crossings);
  for (CenterlineBinding& binding : gathered.binding) binding.segment = excerpt.cone[binding.segment];
  surface = {std::move(gathered.mesh), std::move(gathered.binding), std::move(gathered.radius)};
  return left;
}

}  // namespace vmesh

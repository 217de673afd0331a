#include "surface/guided_growth.h"

#include <mutex>
#include <numbers>
#include <sstream>

#include <tbb/parallel_for.h>

#include "vmesh/core/error.h"

#include "surface/junction/junction_growth.h"
#include "surface/junction/junction_piece.h"
#include "surface/tubes/stitch.h"

namespace vmesh {
namespace {

constexpr int kFewestOnCap = 4;  // vertices of a cap's ring
// Pieces that wait to be assembled: no more, as allocation becomes slower the more small parts memory is in.
constexpr std::size_t kPiecesAtOnce = 1024;

// Vertices and faces of all pieces, by number, before they become one halfedge mesh.
class Assembly {
 public:
  /// `open` says for every node whether the surface is to be open there.
  Assembly(const GrowthSkeleton& skeleton, const std::vector<BranchAxis>& axes, const std::vector<char>& open)
      : skeleton_(skeleton), axes_(axes), open_(open), first_(skeleton.tubes.size()) {}

  // The rings of a tube that no junction's piece replaces.
  void add_tube(Index number) {
    const Tube& tube = skeleton_.tubes[number];
    const std::size_t count = tube.rings.size(), given = rings_given_away(tube);
    const std::size_t begin = tube.starts_at_tip || tube.periodic ? 0 : given;
    const std::size_t end = tube.ends_at_tip || tube.periodic ? count : count - given;
    first_[number].resize(count, kNone);
    for (std::size_t k = begin; k < end; ++k) {
      first_[number][k] = size();
      for (const BoundaryPoint& p : tube.rings[k].points) vertices_.push_back({p.position, p.sample.cone});
    }
    for (std::size_t k = begin; k + 1 < end; ++k) band(ring_vertices(number, k), ring_vertices(number, k + 1));
    if (tube.periodic) band(ring_vertices(number, count - 1), ring_vertices(number, 0));
    if (tube.starts_at_tip) end_at_tip(number, 0, -1, reversed(ring_vertices(number, 0)));
    if (tube.ends_at_tip) end_at_tip(number, count - 1, 1, ring_vertices(number, count - 1));
  }

  void add_junction(const JunctionPiece& piece) {
    std::vector<Index> number;
    for (const PieceVertex& v : piece.vertices) {
      if (v.tube.tube == kNone) {
        number.push_back(size());
        vertices_.push_back({v.position, v.cone, v.fineness, v.lift});
      } else {
        number.push_back(first_[v.tube.tube][v.ring] + v.number);
      }
    }
    for (const auto& [a, b, c] : piece.faces) faces_.push_back({number[a], number[b], number[c]});
  }

  /// Fills in the surface; what is open has lids. Returns the loops around them.
  std::vector<OpenLoop> build(BoundSurface& surface) const {
    std::vector<Vertex> vertex(vertices_.size(), SurfaceMesh::null_vertex());
    for (const Triangle& f : faces_) {
      for (const Index v : f) {
        if (vertex[v] != SurfaceMesh::null_vertex()) continue;
        vertex[v] = surface.mesh.add_vertex(vertices_[v].position);
        surface.place(vertex[v], vertices_[v].position, surface.field.sample(vertices_[v].position, vertices_[v].cone));
        surface.fineness[vertex[v]] = vertices_[v].fineness;
        surface.lift[vertex[v]] = vertices_[v].lift;
      }
    }
    for (const auto& [a, b, c] : faces_) {
      if (surface.mesh.add_face(vertex[a], vertex[b], vertex[c]) == SurfaceMesh::null_face())
        throw std::logic_error("pieces of the surface do not fit together");
    }
    std::vector<OpenLoop> loops;
    for (const auto& [node, ring] : openings_) {
      OpenLoop loop{node, {}};
      for (const Index v : ring) loop.vertices.push_back(vertex[v]);
      surface.close_with_lid(loop.vertices, surface.field.centerline().node(node).position);
      loops.push_back(std::move(loop));
    }
    return loops;
  }

 private:
  // With a cap, or open.
  void end_at_tip(Index number, std::size_t k, double side, std::vector<Index> loop) {
    const Tube& tube = skeleton_.tubes[number];
    const auto& nodes = axes_[tube.branch].branch().nodes;
    const Index node = side < 0 ? nodes.front() : nodes.back();
    if (open_[node]) {
      openings_.push_back({node, std::move(loop)});
    } else {
      cap(tube.rings[k], side, std::move(loop));
    }
  }

  Index size() const { return static_cast<Index>(vertices_.size()); }

  std::vector<Index> ring_vertices(Index tube, std::size_t k) const {
    std::vector<Index> ring(skeleton_.tubes[tube].rings[k].points.size());
    for (std::size_t j = 0; j < ring.size(); ++j) ring[j] = first_[tube][k] + static_cast<Index>(j);
    return ring;
  }

  static std::vector<Index> reversed(std::vector<Index> loop) {
    std::reverse(loop.begin(), loop.end());
    return loop;
  }

  std::vector<Vec3> positions(const std::vector<Index>& loop) const {
    std::vector<Vec3> result;
    for (const Index v : loop) result.push_back(vertices_[v].position);
    return result;
  }

  void band(const std::vector<Index>& bottom, const std::vector<Index>& top) {
    const auto vertex = [&](Index i) { return i < bottom.size() ? bottom[i] : top[i - bottom.size()]; };
    for (const auto& [a, b, c] : stitch(positions(bottom), positions(top)))
      faces_.push_back({vertex(a), vertex(b), vertex(c)});
  }

  // Closes the loop of a tip's ring with a hemisphere: rings of fewer and fewer vertices, and a pole.
  void cap(const Ring& ring, double side, std::vector<Index> loop) {
    const double quarter = std::numbers::pi / 2;
    const auto around = static_cast<double>(loop.size());
    const int bands = std::max(1, static_cast<int>(std::round(quarter / ring_pitch(static_cast<int>(loop.size())))));
    const Vec3 pole = side * ring.normal;
    const Vec3 across = (vertices_[loop.front()].position - ring.center).normalized(), up = pole.cross(across);
    const auto add = [&](const Vec3& way) {
      vertices_.push_back({ring.center + ring.radius * way, ring.points.front().sample.cone});
      return static_cast<Index>(vertices_.size() - 1);
    };
    for (int k = 1; k < bands; ++k) {
      const double latitude = quarter * k / bands;
      const int count = std::max(kFewestOnCap, static_cast<int>(std::round(around * std::cos(latitude))));
      std::vector<Index> next;
      for (int j = 0; j < count; ++j) {
        const double angle = 2 * std::numbers::pi * (j + 0.5 * (k % 2)) / count;
        next.push_back(
            add(std::sin(latitude) * pole + std::cos(latitude) * (std::cos(angle) * across + std::sin(angle) * up)));
      }
      band(loop, next);
      loop = std::move(next);
    }
    const Index apex = add(pole);
    for (std::size_t j = 0; j < loop.size(); ++j) faces_.push_back({loop[j], loop[(j + 1) % loop.size()], apex});
  }

  struct TipRing {
    Index node;
    std::vector<Index> vertices;
  };

  const GrowthSkeleton& skeleton_;
  const std::vector<BranchAxis>& axes_;
  const std::vector<char>& open_;
  std::vector<TipRing> openings_;
  std::vector<SurfacePoint> vertices_;
  std::vector<Triangle> faces_;
  std::vector<std::vector<Index>> first_;  // vertex of every ring of every tube
};

// Makes the pieces of all junctions, some at a time. They do not depend on each other, nor on the number of threads.
class PieceMaker {
 public:
  PieceMaker(const VesselField& field, const std::vector<BranchAxis>& axes, const GrowthSkeleton& skeleton,
             const GenerateOptions& options, const Progress& progress)
      : field_(field), axes_(axes), skeleton_(skeleton), options_(options), progress_(progress) {}

  // The next ones; none after the last.
  std::vector<JunctionPiece> next() {
    const std::size_t first = done_, count = std::min(kPiecesAtOnce, skeleton_.junctions.size() - first);
    std::vector<JunctionPiece> pieces(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      report_progress(ask_, "grow", 0);
      pieces[i] = make_junction_piece(field_, axes_, skeleton_, skeleton_.junctions[first + i], options_, ask_);
      const std::lock_guard lock(reporting_);
      ++done_;
    });
    return pieces;
  }

 private:
  const VesselField& field_;
  const std::vector<BranchAxis>& axes_;
  const GrowthSkeleton& skeleton_;
  const GenerateOptions& options_;
  const Progress& progress_;
  std::mutex reporting_;
  std::size_t done_ = 0;
  // Every sweep of a piece asks whether to go on; what it tells is how many pieces are done.
  const Progress ask_ = [this](std::string_view, double) {
    const std::lock_guard lock(reporting_);
    const double fraction = static_cast<double>(done_) / static_cast<double>(skeleton_.junctions.size());
    return !progress_ || progress_("grow", fraction);
  };
};

std::string at(const Vec3& p) {
  std::ostringstream text;
  text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
  return text.str();
}

// What growing this junction as one piece leaves out of the centerline's graph.
void note_simplifications(const Centerline& centerline, const std::vector<BranchAxis>& axes, const Junction& junction,
                          std::size_t filled_loops, std::vector<GrowthSimplification>& notes) {
  GrowthSimplification note;
  std::size_t inner_branches = 0;
  note.nodes = junction.nodes;
  for (const Gap& gap : junction.gaps) {
    if (gap.openings[0].tube != kNone || gap.openings[1].tube != kNone) continue;
    const auto& segments = axes[gap.branch].branch().segments;
    note.segments.insert(note.segments.end(), segments.begin(), segments.end());
    ++inner_branches;
  }
  double widest = 0;
  for (const Index n : junction.nodes) {
    if (centerline.node(n).radius <= widest) continue;
    widest = centerline.node(n).radius;
    note.position = centerline.node(n).position;
  }
  if (junction.nodes.empty()) note.position = axes[junction.gaps[0].branch].at(junction.gaps[0].begin).position;
  if (junction.nodes.size() > 1) {
    note.kind = GrowthSimplification::Kind::merged_nodes;
    note.message = std::to_string(junction.nodes.size()) + " nodes around " + at(note.position) +
                   " grew as one junction: nowhere between them does a vessel have a cross-section of its own; " +
                   std::to_string(inner_branches) + " branches lie wholly within it";
    notes.push_back(note);
  }
  if (filled_loops > 0) {
    note.kind = GrowthSimplification::Kind::filled_loop;
    note.message = std::to_string(filled_loops) + " loops around " + at(note.position) +
                   " are too short to have a hole; the surface is filled there";
    notes.push_back(note);
  }
}

}  // namespace

GuidedGrowthReport grow_guided(BoundSurface& surface, const std::vector<char>& open, const GenerateOptions& options,
                               const Progress& progress) {
  const VesselField& field = surface.field;
  const std::vector<Branch> branches = find_branches(field.centerline());
  std::vector<BranchAxis> axes;
  for (const Branch& branch : branches) axes.emplace_back(field.centerline(), branch);
  const GrowthSkeleton skeleton = make_growth_skeleton(field, axes, options.around);

  GuidedGrowthReport report;
  GrowthSummary& summary = report.summary;
  summary.junctions = skeleton.junctions.size();
  summary.tubes = skeleton.tubes.size();
  summary.components = skeleton.component_count();
  summary.cycle_rank = skeleton.cycle_rank();

  Assembly assembly(skeleton, axes, open);
  for (Index t = 0; t < skeleton.tubes.size(); ++t) assembly.add_tube(t);
  PieceMaker maker(field, axes, skeleton, options, progress);
  for (auto junction = skeleton.junctions.begin(); junction != skeleton.junctions.end();) {
    for (const JunctionPiece& piece : maker.next()) {
      assembly.add_junction(piece);
      summary.cycle_rank += piece.handles;
      report.filled_loops += piece.filled_loops;
      report.tangled_junctions += piece.tangles > 0;
      note_simplifications(field.centerline(), axes, *junction++, piece.filled_loops, summary.simplifications);
    }
  }
  report.open_loops = assembly.build(surface);
  return report;
}

}  // namespace vmesh

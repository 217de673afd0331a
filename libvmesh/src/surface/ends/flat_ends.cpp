#include "vmesh/surface/flat_ends.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vmesh/core/error.h"
#include "vmesh/edit/crossing_guard.h"
#include "vmesh/surface/defects.h"

#include "surface/ends/disc.h"
#include "surface/ends/opening_extension.h"
#include "surface/ends/ring_moves.h"

namespace vmesh {
namespace {

class EndFinisher {
 public:
  EndFinisher(GenerateResult& result, const Centerline& centerline, const FlatEndOptions& options)
      : result_(result), options_(options) {
    Index label = 0;
    label_.resize(centerline.nodes().size(), 0);
    for (Index n = 0; n < label_.size(); ++n) {
      if (centerline.degree(n) == 1) label_[n] = ++label;
    }
  }

  FlatEnds run() {
    std::vector<Opening> open;
    SectionEnds sections = end_at_sections(result_, options_.sections, options_.keep_area);
    ends_.not_kept = std::move(sections.not_kept);
    if (options_.keep_area) scale_rings(sections.kept);
    for (Opening& opening : result_.openings) {
      const bool at_section = std::binary_search(sections.kept.begin(), sections.kept.end(), opening.node);
      if (options_.extension > 0) extend(opening);
      const std::vector<Vec3> ring = ring_positions(result_.mesh, opening);
      const Vec3 area = area_vector(ring);
      FlatEnd end{label_[opening.node], opening.node, area_centroid(ring), area.normalized(),
                  area.norm(),          false,        at_section};
      const auto& left_open = options_.left_open;
      end.capped = options_.cap && std::find(left_open.begin(), left_open.end(), end.node) == left_open.end();
      if (end.capped) {
        cap(opening, ring, end);
      } else {
        open.push_back(std::move(opening));
      }
      ends_.ends.push_back(end);
    }
    result_.openings = std::move(open);
    ends_.cap_label.resize(result_.mesh.faces.size(), 0);
    return std::move(ends_);
  }

 private:
  struct ScaledRing {
    const Opening* opening;
    std::vector<Vec3> before;
  };

  // Of rings that are not at a section. Those whose faces then cross others get their positions back.
  void scale_rings(const std::vector<Index>& nodes_at_sections) {
    std::vector<ScaledRing> scaled;
    for (const Opening& opening : result_.openings) {
      if (std::binary_search(nodes_at_sections.begin(), nodes_at_sections.end(), opening.node)) continue;
      scaled.push_back({&opening, ring_positions(result_.mesh, opening)});
      const double factor = std::sqrt(std::numbers::pi / area_vector(scaled.back().before).norm()) * opening.radius;
      for (const Index v : opening.ring) {
        Vec3& p = result_.mesh.vertices[v];
        p = opening.center + factor * (p - opening.center);
      }
    }
    while (!scaled.empty() && take_back_crossing(scaled)) {
    }
    std::sort(ends_.narrowed.begin(), ends_.narrowed.end());
  }

  // Whether there were any.
  bool take_back_crossing(std::vector<ScaledRing>& scaled) {
    const std::vector<char> crosses = vertices_of_crossing_faces();
    const std::size_t taken_back = std::erase_if(scaled, [&](const ScaledRing& ring) {
      const std::vector<Index>& vertices = ring.opening->ring;
      if (std::none_of(vertices.begin(), vertices.end(), [&](Index v) { return crosses[v]; })) return false;
      for (std::size_t j = 0; j < vertices.size(); ++j) result_.mesh.vertices[vertices[j]] = ring.before[j];
      ends_.narrowed.push_back(ring.opening->node);
      return true;
    });
    return taken_back > 0;
  }

  // For every vertex, whether it is of a face at a ring, or of the lid there, that crosses another, or of the other.
  std::vector<char> vertices_of_crossing_faces() const {
    const TriMesh closed = with_lids(result_);
    std::vector<char> is_on_ring = vertices_on_rings(result_), crosses(closed.vertices.size(), 0);
    is_on_ring.resize(closed.vertices.size(), 0);
    std::vector<Index> at_rings;
    for (Index f = 0; f < closed.faces.size(); ++f) {
      const Triangle& face = closed.faces[f];
      if (std::any_of(face.begin(), face.end(), [&](Index v) { return is_on_ring[v]; })) at_rings.push_back(f);
    }
    for (const auto& [f, g] : crossing_pairs(closed.vertices, closed.faces, at_rings)) {
      for (const Index face : {f, g})
        for (const Index v : closed.faces[face]) crosses[v] = 1;
    }
    return crosses;
  }

  void extend(Opening& opening) {
    const std::vector<Vec3> ring = ring_positions(result_.mesh, opening);
    const Vec3 area = area_vector(ring);
    const Vec3 shift = options_.extension * std::sqrt(area.norm() / std::numbers::pi) * area.normalized();
    std::vector<Vec3> target = ring;
    for (Vec3& p : target) p += shift;
    extend_opening(result_, opening, target);
    opening.center += shift;
  }

  void cap(const Opening& opening, const std::vector<Vec3>& ring, const FlatEnd& end) {
    ends_.cap_label.resize(result_.mesh.faces.size(), 0);
    const Disc disc = fill_ring(ring, end.normal);
    std::vector<Index> number = opening.ring;
    for (const Vec3& p : disc.vertices) number.push_back(add_vertex_like(result_, opening.ring[0], p));
    for (const auto& [a, b, c] : disc.faces) result_.mesh.faces.push_back({number[a], number[b], number[c]});
    ends_.cap_label.resize(result_.mesh.faces.size(), end.label);
  }

  GenerateResult& result_;
  const FlatEndOptions& options_;
  std::vector<Index> label_;  // of nodes that are ends
  FlatEnds ends_;
};

}  // namespace

std::vector<std::string> problems_of(const FlatEnds& ends) {
  std::vector<std::string> problems;
  for (const SectionNotKept& end : ends.not_kept)
    problems.push_back("the flat end at node " + std::to_string(end.node) + " is not kept: " + end.reason +
                       "; the vessel is cut across its axis there");
  for (const Index node : ends.narrowed)
    problems.push_back("the end at node " + std::to_string(node) +
                       " is smaller than the vessel there: with all of its area, faces would cross");
  return problems;
}

FlatEnds finish_ends(GenerateResult& result, const Centerline& centerline, const FlatEndOptions& options) {
  if (!(options.extension >= 0 && std::isfinite(options.extension)))
    throw InvalidInput("the extension of ends must be >= 0");
  if (result.openings.empty()) return {{}, std::vector<Index>(result.mesh.faces.size(), 0), {}, {}};
  FlatEnds ends = EndFinisher(result, centerline, options).run();
  find_defects_again(centerline, self_intersections(result.mesh), result);
  return ends;
}

}  // namespace vmesh

#include "vmesh/surface/flat_ends.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vmesh/core/error.h"
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
    for (Opening& opening : result_.openings) {
      const bool at_section = std::binary_search(sections.kept.begin(), sections.kept.end(), opening.node);
      if (options_.keep_area && !at_section) scale(opening);
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
  void scale(const Opening& opening) {
    const std::vector<Vec3> ring = ring_positions(result_.mesh, opening);
    const double factor = std::sqrt(std::numbers::pi / area_vector(ring).norm()) * opening.radius;
    for (const Index v : opening.ring) {
      Vec3& p = result_.mesh.vertices[v];
      p = opening.center + factor * (p - opening.center);
    }
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

FlatEnds finish_ends(GenerateResult& result, const Centerline& centerline, const FlatEndOptions& options) {
  if (!(options.extension >= 0 && std::isfinite(options.extension)))
    throw InvalidInput("the extension of ends must be >= 0");
  if (result.openings.empty()) return {{}, std::vector<Index>(result.mesh.faces.size(), 0), {}};
  FlatEnds ends = EndFinisher(result, centerline, options).run();
  find_defects_again(centerline, self_intersections(result.mesh), result);
  return ends;
}

}  // namespace vmesh

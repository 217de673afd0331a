#include "vmesh/surface/flat_ends.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/edit/crossing_guard.h"
#include "vmesh/surface/branch_labels.h"
#include "vmesh/surface/defects.h"
#include "vmesh/surface/disc.h"

#include "surface/ends/extension_room.h"
#include "surface/ends/opening_extension.h"
#include "surface/ends/overhangs.h"
#include "surface/ends/ring_moves.h"

namespace vmesh {
namespace {

class EndFinisher {
 public:
  EndFinisher(GenerateResult& result, const Centerline& centerline, const FlatEndOptions& options)
      : result_(result), centerline_(centerline), options_(options) {
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
    ends_.narrowed = std::move(sections.narrowed);
    if (options_.keep_area && !options_.fitted) scale_rings(sections.kept);
    std::sort(ends_.narrowed.begin(), ends_.narrowed.end());
    if (options_.fitted && options_.cap && options_.extension == 0) lower_overhangs(result_);
    if (options_.extension > 0) room_.emplace(result_);
    for (Opening& opening : result_.openings) {
      const bool at_section = std::binary_search(sections.kept.begin(), sections.kept.end(), opening.node);
      if (!finish(opening, at_section)) open.push_back(std::move(opening));
    }
    result_.openings = std::move(open);
    ends_.cap_label.resize(result_.mesh.faces.size(), 0);
    return std::move(ends_);
  }

  /// The extensions that are left out, or whose faces cross others. `crossings`: pairs of faces of the finished
  /// surface.
  std::vector<BlockedExtension> blocked(const std::vector<std::pair<Index, Index>>& crossings) const {
    std::vector<BlockedExtension> blocked;
    if (tight_.empty()) return blocked;
    const std::vector<Index> branch = branch_label_of_cones(centerline_);
    for (const TightExtension& tight : tight_) {
      const auto is_of_it = [&](Index f) { return tight.first_face <= f && f < tight.end_face; };
      const bool crosses = std::any_of(crossings.begin(), crossings.end(),
                                       [&](const auto& pair) { return is_of_it(pair.first) || is_of_it(pair.second); });
      if (!crosses && tight.length > 0) continue;
      const Index segment = result_.binding[tight.room.vertex].segment;
      blocked.push_back(
          {tight.node, tight.length, tight.room.length / tight.radius, branch.at(segment), tight.room.at});
    }
    return blocked;
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

  /// Whether the opening was capped.
  bool finish(Opening& opening, bool at_section) {
    const std::size_t first_face = result_.mesh.faces.size();
    const double extension = options_.extension > 0 ? extend(opening) : 0;
    const std::vector<Vec3> ring = ring_positions(result_.mesh, opening);
    const Vec3 area = area_vector(ring);
    FlatEnd end{label_[opening.node], opening.node, area_centroid(ring), area.normalized(),
                area.norm(),          false,        at_section,          extension};
    const auto& left_open = options_.left_open;
    end.capped = options_.cap && std::find(left_open.begin(), left_open.end(), end.node) == left_open.end();
    if (end.capped) cap(opening, ring, end);
    ends_.ends.push_back(end);
    if (!tight_.empty() && tight_.back().node == end.node) {
      tight_.back().first_face = first_face;
      tight_.back().end_face = result_.mesh.faces.size();
    }
    return end.capped;
  }

  // Returns the length of the extension, in radii.
  double extend(Opening& opening) {
    const std::vector<Vec3> ring = ring_positions(result_.mesh, opening);
    const Vec3 area = area_vector(ring);
    const double radius = std::sqrt(area.norm() / std::numbers::pi);
    const ExtensionRoom::Room room = room_->ahead(opening, ring, options_.extension * radius);
    const double length = options_.fit_extensions ? fitted(room.length / radius) : options_.extension;
    if (room.vertex != kNone) tight_.push_back({opening.node, length, radius, room});
    if (length == 0) return 0;
    const Vec3 shift = length * radius * area.normalized();
    std::vector<Vec3> target = ring;
    for (Vec3& p : target) p += shift;
    const std::size_t first_face = result_.mesh.faces.size();
    extend_opening(result_, opening, target);
    opening.center += shift;
    room_->add(result_.mesh, first_face, opening.ring);
    return length;
  }

  static double fitted(double room) {
    constexpr double kShortest = 0.5;
    return room < kShortest ? 0 : room;
  }

  void cap(const Opening& opening, const std::vector<Vec3>& ring, const FlatEnd& end) {
    ends_.cap_label.resize(result_.mesh.faces.size(), 0);
    const Disc disc = fill_ring(ring, end.normal);
    std::vector<Index> number = opening.ring;
    for (const Vec3& p : disc.vertices) number.push_back(add_vertex_like(result_, opening.ring[0], p));
    for (const auto& [a, b, c] : disc.faces) result_.mesh.faces.push_back({number[a], number[b], number[c]});
    ends_.cap_label.resize(result_.mesh.faces.size(), end.label);
  }

  struct TightExtension {
    Index node;
    double length, radius;  // in radii, and in mm
    ExtensionRoom::Room room;
    std::size_t first_face = 0, end_face = 0;  // of the extension and its cap
  };

  GenerateResult& result_;
  const Centerline& centerline_;
  const FlatEndOptions& options_;
  std::optional<ExtensionRoom> room_;
  std::vector<TightExtension> tight_;  // in whose way something is
  std::vector<Index> label_;           // of nodes that are ends
  FlatEnds ends_;
};

std::string problem_of(const BlockedExtension& extension) {
  const std::string node = std::to_string(extension.node);
  const std::string obstacle =
      "the vessel of branch " + std::to_string(extension.branch) + " at " + point_text(extension.at);
  const double longest = std::floor(100 * extension.longest) / 100;  // not longer than fits
  if (extension.length == 0)
    return "the end at node " + node + " has no flow extension: " + obstacle +
           formatted(" leaves room for %.2f radii", longest);
  return "the flow extension at node " + node + formatted(", %g radii long, runs into ", extension.length) + obstacle +
         formatted("; at most %.2f radii fit there", longest);
}

}  // namespace

std::vector<std::string> problems_of(const FlatEnds& ends) {
  std::vector<std::string> problems;
  for (const SectionNotKept& end : ends.not_kept)
    problems.push_back("the flat end at node " + std::to_string(end.node) + " is not kept: " + end.reason +
                       "; the vessel is cut across its axis there");
  for (const Index node : ends.narrowed)
    problems.push_back("the end at node " + std::to_string(node) +
                       " is smaller than the vessel there: with all of its area, faces would cross");
  for (const BlockedExtension& extension : ends.blocked) problems.push_back(problem_of(extension));
  return problems;
}

FlatEnds finish_ends(GenerateResult& result, const Centerline& centerline, const FlatEndOptions& options) {
  if (!(options.extension >= 0 && std::isfinite(options.extension)))
    throw InvalidInput("the extension of ends must be >= 0");
  if (result.openings.empty()) return {{}, std::vector<Index>(result.mesh.faces.size(), 0), {}, {}, {}};
  EndFinisher finisher(result, centerline, options);
  FlatEnds ends = finisher.run();
  const auto crossings = self_intersections(result.mesh);
  ends.blocked = finisher.blocked(crossings);
  find_defects_again(centerline, crossings, result);
  return ends;
}

}  // namespace vmesh

#include "vmesh/surface/section_ends.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "vmesh/core/text.h"
#include "vmesh/surface/disc.h"
#include "vmesh/surface/metric_skewness.h"

#include "surface/ends/opening_extension.h"
#include "surface/ends/ring_moves.h"

namespace vmesh {
namespace {

constexpr double kSectionFacing = 0.7;   // cosine between the normals of an opening and its section: 45 degrees
constexpr double kFarthestCenter = 0.5;  // radii from the middle of the ring to the section's centre
constexpr double kCrossing = 1e-12;      // relative: rays through corners of a ring count as meeting both edges

std::string text_of(double value, const char* unit) { return formatted("%.2g%s", value, unit); }

/// How far from the section's centre its ring is, in a direction in its plane, where it is farthest; nullopt if the
/// ring is not met. A ring that is not flat is projected into the plane.
std::optional<double> distance_to_ring(const EndSection& section, const Vec3& direction) {
  const Vec3 across = section.normal.cross(direction);
  std::optional<double> farthest;
  for (std::size_t i = 0; i < section.ring.size(); ++i) {
    const Vec3 a = section.ring[i] - section.center;
    const Vec3 b = section.ring[(i + 1) % section.ring.size()] - section.center;
    const double side_a = across.dot(a), side_b = across.dot(b), extent = side_b - side_a;
    const double at = -side_a / extent;
    if (extent == 0 || !(at >= -kCrossing && at <= 1 + kCrossing)) continue;
    const double distance = direction.dot(a + at * (b - a));
    if (distance > 0 && !(farthest && *farthest > distance)) farthest = distance;
  }
  return farthest;
}

/// Where a ring goes in the plane of its section.
class RingPlacement {
 public:
  RingPlacement(const Opening& opening, const std::vector<Vec3>& ring, const EndSection& section)
      : opening_(opening), ring_(ring), section_(section) {}

  std::vector<Vec3> targets;  ///< of the ring's vertices
  std::string problem;        ///< why there is none; empty if there is

  void run() {
    const double facing = opening_.normal.dot(section_.normal);
    if (!(facing > kSectionFacing)) {
      const double angle = std::acos(std::clamp(facing, -1.0, 1.0)) * 180 / M_PI;
      problem = "its plane is " + text_of(angle, " degrees") + " off the vessel's cross-section";
      return;
    }
    const double radius = radius_of(section_);
    const double off = (section_.center - area_centroid(ring_)).norm();
    if (!(off <= kFarthestCenter * radius)) {
      problem = "its centre is " + text_of(off / radius, " radii") + " from the middle of the vessel's end";
      return;
    }
    cut_by_plane();
    if (!section_.ring.empty()) meet_ring();
  }

  /// The targets around the section's centre, scaled to its area.
  std::vector<Vec3> scaled_targets() const {
    std::vector<Vec3> scaled = targets;
    const Vec3 middle = section_.ring.empty() ? area_centroid(targets) : section_.center;
    const double factor = std::sqrt(section_.area / area_vector(targets).norm());
    for (Vec3& p : scaled) p = section_.center + factor * (p - middle);
    return scaled;
  }

 private:
  /// Moves vertices along the vessel into the plane.
  void cut_by_plane() {
    const Vec3 way = opening_.normal / opening_.normal.dot(section_.normal);
    for (const Vec3& p : ring_) targets.push_back(p + (section_.center - p).dot(section_.normal) * way);
  }

  void meet_ring() {
    const Vec3 middle = area_centroid(targets);
    for (Vec3& p : targets) {
      const Vec3 direction = (p - middle).normalized();
      const std::optional<double> distance = distance_to_ring(section_, direction);
      if (!distance) {
        problem = "its ring does not go around its centre";
        return;
      }
      p = section_.center + *distance * direction;
    }
  }

  const Opening& opening_;
  const std::vector<Vec3>& ring_;
  const EndSection& section_;
};

class SectionEnder {
 public:
  SectionEnder(GenerateResult& result, bool to_area)
      : result_(result), to_area_(to_area), vertices_before_(result.mesh.vertices), openings_before_(result.openings) {}

  SectionEnds run(const std::vector<EndSection>& sections) {
    plan_all(sections);
    apply_plans();
    while (change_faulty()) apply_plans();
    for (const Plan& plan : plans_) {
      const Index node = openings_before_[plan.opening].node;
      ends_.kept.push_back(node);
      if (plan.narrowed) ends_.narrowed.push_back(node);
    }
    std::sort(ends_.kept.begin(), ends_.kept.end());
    return std::move(ends_);
  }

 private:
  struct Plan {
    std::size_t opening = 0;
    const EndSection* section = nullptr;
    std::vector<VertexMove> moves;
    std::vector<VertexMove> moves_onto_ring;  // instead, if those to the area are at fault
    bool narrowed = false;                    // they were
  };

  void plan_all(const std::vector<EndSection>& sections) {
    std::map<Index, const EndSection*> section_at;
    for (const EndSection& section : sections) section_at.emplace(section.node, &section);
    const std::vector<std::vector<Index>> around = neighbours(result_.mesh);
    const std::vector<char> is_on_ring = vertices_on_rings(result_);
    for (std::size_t i = 0; i < openings_before_.size(); ++i) {
      const Opening& opening = openings_before_[i];
      const auto section = section_at.find(opening.node);
      if (section == section_at.end()) continue;
      const std::vector<Vec3> ring = ring_positions(result_.mesh, opening);
      RingPlacement placement(opening, ring, *section->second);
      placement.run();
      if (!placement.problem.empty()) {
        ends_.not_kept.push_back({opening.node, placement.problem});
        continue;
      }
      const auto moves_to = [&](const std::vector<Vec3>& targets) {
        std::vector<Vec3> ways;
        for (std::size_t j = 0; j < ring.size(); ++j) ways.push_back(targets[j] - ring[j]);
        return spread_moves(around, is_on_ring, opening.ring, ways, mean_edge(ring));
      };
      Plan plan{i, section->second, moves_to(to_area_ ? placement.scaled_targets() : placement.targets), {}, false};
      if (to_area_ && !section->second->ring.empty()) plan.moves_onto_ring = moves_to(placement.targets);
      plans_.push_back(std::move(plan));
    }
  }

  void apply_plans() {
    result_.mesh.vertices = vertices_before_;
    result_.openings = openings_before_;
    for (const Plan& plan : plans_) {
      apply_moves(plan.moves, result_.mesh);
      result_.openings[plan.opening].center = plan.section->center;
      result_.openings[plan.opening].normal = plan.section->normal;
    }
  }

  /// Gives up the area, or else the section, where that moved vertices of faces that cross or are degenerate; whether
  /// there were any.
  bool change_faulty() {
    std::map<Index, std::string> fault_at;      // by vertex
    const TriMesh closed = with_lids(result_);  // the wall must not go beyond an end's plane either
    for (const auto& [f, g] : self_intersections(closed)) {
      for (const Index face : {f, g})
        for (const Index v : closed.faces[face]) fault_at[v] = "faces would cross";
    }
    const std::vector<double> skewness = metric_skewness(result_.mesh, result_.elongation);
    for (Index f = 0; f < skewness.size(); ++f) {
      if (skewness[f] <= kWorstSkewness) continue;
      for (const Index v : result_.mesh.faces[f])
        fault_at[v] = "a triangle would have a skewness of " + text_of(skewness[f], "");
    }
    bool changed = false;
    std::erase_if(plans_, [&](Plan& plan) {
      const auto at_fault = std::find_if(plan.moves.begin(), plan.moves.end(), [&](const VertexMove& move) {
        return fault_at.contains(move.vertex) && !move.way.isZero(0);
      });
      if (at_fault == plan.moves.end()) return false;
      changed = true;
      plan.narrowed = !plan.narrowed && !plan.moves_onto_ring.empty();
      if (plan.narrowed) {
        plan.moves = plan.moves_onto_ring;
        return false;
      }
      ends_.not_kept.push_back({openings_before_[plan.opening].node, fault_at[at_fault->vertex]});
      return true;
    });
    return changed;
  }

  GenerateResult& result_;
  bool to_area_;
  const std::vector<Vec3> vertices_before_;
  const std::vector<Opening> openings_before_;
  std::vector<Plan> plans_;
  SectionEnds ends_;
};

}  // namespace

SectionEnds end_at_sections(GenerateResult& result, const std::vector<EndSection>& sections, bool to_area) {
  if (sections.empty() || result.openings.empty()) return {};
  return SectionEnder(result, to_area).run(sections);
}

}  // namespace vmesh

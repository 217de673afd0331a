#include "vmesh/surface/defects.h"

#include <algorithm>
#include <optional>
#include <sstream>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/disjoint_sets.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/metric_skewness.h"

namespace vmesh {

std::string_view to_string(DefectKind kind) {
  switch (kind) {
    case DefectKind::not_closed:
      return "not_closed";
    case DefectKind::not_manifold:
      return "not_manifold";
    case DefectKind::wrong_topology:
      return "wrong_topology";
    case DefectKind::inside_out:
      return "inside_out";
    case DefectKind::crossing_faces:
      return "crossing_faces";
    case DefectKind::bad_triangle:
      return "bad_triangle";
    case DefectKind::node_outside:
      break;
  }
  return "node_outside";
}

namespace {

std::string counted(std::size_t count, const char* singular, const char* plural) {
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}

class DefectSearch {
 public:
  DefectSearch(const Centerline& centerline, const GenerateResult& result)
      : centerline_(centerline), result_(result), mesh_(result.mesh) {
    if (!result.openings.empty()) with_lids_ = with_lids(result);
  }

  void run(const std::vector<std::pair<Index, Index>>& crossings) {
    run_on_faces(crossings);
    nodes_outside();
  }

  void run_on_faces(const std::vector<std::pair<Index, Index>>& crossings) {
    topology();
    faces_that_cross(crossings);
    bad_triangles();
  }

  std::vector<Defect> defects;
  SurfaceCheck check;

 private:
  void add(DefectKind kind, const Vec3& position, std::size_t count, const std::string& what) {
    Defect defect{kind, position, count, kNone, kNone, kNone, {}};
    std::ostringstream text;
    text << what << " at (" << position.x() << ", " << position.y() << ", " << position.z() << ")";
    double nearest = std::numeric_limits<double>::infinity();
    for (Index v = 0; v < mesh_.vertices.size(); ++v) {
      const double away = (mesh_.vertices[v] - position).squaredNorm();
      if (away >= nearest) continue;
      nearest = away;
      defect.segment = result_.binding[v].segment;
    }
    nearest = std::numeric_limits<double>::infinity();
    for (Index n = 0; n < centerline_.nodes().size(); ++n) {
      const double away = (centerline_.node(n).position - position).squaredNorm();
      if (away >= nearest) continue;
      nearest = away;
      defect.node = n;
    }
    defect.branch = branch_of(defect.segment);
    defect.message = text.str();
    defects.push_back(std::move(defect));
  }

  Index branch_of(Index segment) {
    if (branch_of_.empty()) {
      branch_of_.resize(centerline_.segments().size(), kNone);
      const std::vector<Branch> branches = find_branches(centerline_);
      for (Index b = 0; b < branches.size(); ++b)
        for (const Index s : branches[b].segments) branch_of_[s] = b;
    }
    return segment < branch_of_.size() ? branch_of_[segment] : kNone;  // none of an isolated node
  }

  void topology() {
    const Topology& topology = check.topology = measure_topology(closed());
    const Vec3 somewhere = mesh_.vertices.empty() ? Vec3(Vec3::Zero()) : mesh_.vertices.front();
    if (!topology.closed)
      add(DefectKind::not_closed, somewhere, topology.boundary_edges,
          counted(topology.boundary_edges, "boundary edge", "boundary edges"));
    if (!topology.manifold || !topology.oriented)
      add(DefectKind::not_manifold, somewhere, std::max<std::size_t>(1, topology.crowded_edges),
          "not an oriented manifold");
    if (!topology.closed || !topology.manifold || !topology.oriented) return;
    if (!topology.outward) add(DefectKind::inside_out, somewhere, 1, "a component is inside out");
    const bool guided = result_.growth.components > 0;
    const std::size_t components = guided ? result_.growth.components : centerline_.component_count();
    const std::size_t loops = guided ? result_.growth.cycle_rank : centerline_.cycle_rank();
    if (topology.components != components)
      add(DefectKind::wrong_topology, somewhere, 1,
          counted(topology.components, "component", "components") + " where the centerline has " +
              std::to_string(components));
    if (topology.genus != static_cast<std::int64_t>(loops))
      add(DefectKind::wrong_topology, somewhere, 1,
          "genus " + std::to_string(topology.genus) + " where the centerline has " + counted(loops, "loop", "loops"));
  }

  const TriMesh& closed() const { return with_lids_ ? *with_lids_ : mesh_; }

  Vec3 center(Index f) const {
    const auto& [a, b, c] = mesh_.faces[f];
    return (mesh_.vertices[a] + mesh_.vertices[b] + mesh_.vertices[c]) / 3;
  }

  // Pairs connected by common vertices are one defect.
  void faces_that_cross(const std::vector<std::pair<Index, Index>>& crossings) {
    check.crossing_pairs = crossings.size();
    if (crossings.empty()) return;
    DisjointSets places(mesh_.vertices.size());
    for (const auto& [f, g] : crossings) {
      for (const Index face : {f, g}) {
        for (const Index v : mesh_.faces[face]) places.join(mesh_.faces[f][0], v);
      }
    }
    std::vector<std::size_t> count(mesh_.vertices.size(), 0);
    std::vector<Index> example(mesh_.vertices.size(), kNone), order;
    for (const auto& [f, g] : crossings) {
      const Index place = places.find(mesh_.faces[f][0]);
      if (count[place]++ == 0) {
        example[place] = f;
        order.push_back(place);
      }
    }
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return count[a] > count[b]; });
    for (const Index place : order)
      add(DefectKind::crossing_faces, center(example[place]), count[place],
          counted(count[place], "pair of faces crosses", "pairs of faces cross"));
  }

  void bad_triangles() {
    Index worst = kNone;
    std::size_t count = 0;
    const std::vector<double> skewness = metric_skewness(mesh_, result_.elongation);
    for (Index f = 0; f < skewness.size(); ++f) {
      if (skewness[f] <= kWorstSkewness) continue;
      if (worst == kNone || skewness[f] > skewness[worst]) worst = f;
      ++count;
    }
    if (worst == kNone) return;
    std::ostringstream text;
    text << counted(count, "triangle is", "triangles are") << " nearly degenerate, the worst of skewness "
         << skewness[worst];
    add(DefectKind::bad_triangle, center(worst), count, text.str());
  }

  // Segments of branches that were left out: their ends may protrude from the other vessels a little.
  std::vector<char> segments_left_out() const {
    std::vector<char> left_out(centerline_.segments().size(), 0);
    for (const GrowthSimplification& note : result_.growth.simplifications) {
      if (note.kind != GrowthSimplification::Kind::buried_branch) continue;
      for (const Index s : note.segments) left_out[s] = 1;
    }
    return left_out;
  }

  void nodes_outside() {
    if (!check.topology.closed) return;
    std::vector<Vec3> positions;
    for (const CenterlineNode& node : centerline_.nodes()) positions.push_back(node.position);
    std::vector<bool> inside = points_inside(closed(), positions);
    for (const Opening& opening : result_.openings) inside[opening.node] = true;
    check.nodes_inside = static_cast<std::size_t>(std::count(inside.begin(), inside.end(), true));
    const std::vector<char> left_out = segments_left_out();
    for (Index n = 0; n < inside.size(); ++n) {
      const auto segments = centerline_.incident_segments(n);
      const bool listed =
          !segments.empty() && std::all_of(segments.begin(), segments.end(), [&](Index s) { return left_out[s] != 0; });
      if (!inside[n] && !listed)
        add(DefectKind::node_outside, positions[n], 1, "a node of the centerline is not inside");
    }
  }

  const Centerline& centerline_;
  const GenerateResult& result_;
  const TriMesh& mesh_;
  std::optional<TriMesh> with_lids_;  // where it has openings
  std::vector<Index> branch_of_;      // of every segment, once that is needed
};

}  // namespace

void find_defects(const Centerline& centerline, const std::vector<std::pair<Index, Index>>& crossings,
                  GenerateResult& result) {
  DefectSearch search(centerline, result);
  search.run(crossings);
  result.defects = std::move(search.defects);
  result.check = search.check;
}

void find_defects_again(const Centerline& centerline, const std::vector<std::pair<Index, Index>>& crossings,
                        GenerateResult& result) {
  DefectSearch search(centerline, result);
  search.run_on_faces(crossings);
  for (Defect& defect : result.defects) {
    if (defect.kind == DefectKind::node_outside) search.defects.push_back(std::move(defect));
  }
  search.check.nodes_inside = result.check.nodes_inside;
  result.defects = std::move(search.defects);
  result.check = search.check;
}

}  // namespace vmesh

#include "solid/wall_frame.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/mesh/check_indices.h"
#include "vmesh/mesh/topology.h"

namespace vmesh {
namespace {

// A cap may differ from its plane by this share of the root of its area: rings are placed on planes to rounding, and
// files of single precision differ by 1e-6 where vessels lie within a metre of the origin.
constexpr double kMostUneven = 1e-3;

void check_sizes(const VesselWall& wall) {
  check_indices(wall.mesh);
  if (wall.radius.size() != wall.mesh.vertices.size() || wall.patch.size() != wall.mesh.faces.size())
    throw InvalidInput("a surface needs a radius for every vertex and a patch for every face");
  for (const Index patch : wall.patch) {
    if (patch >= wall.patch_names.size()) throw InvalidInput("a face has a patch without a name");
  }
}

void check_surface(const TriMesh& mesh) {
  const Topology topology = measure_topology(mesh);
  if (!topology.closed)
    throw InvalidInput("the surface is open (" + counted(topology.boundary_edges, "edge", "edges") +
                       " with one face): close it, by vmesh generate --ends flat for example");
  if (!topology.manifold || !topology.oriented)
    throw InvalidInput("the surface is not manifold: " + counted(topology.crowded_edges, "edge", "edges") +
                       " with three faces or more, or faces that disagree about the outside");
  if (!topology.outward) throw InvalidInput("the surface is inside out, or a part of it is; turn its faces over");
  const std::vector<Index> flat = degenerate_faces(mesh);
  if (!flat.empty())
    throw InvalidInput(counted(flat.size(), "face", "faces") + " without area, the first at " +
                       point_text(mesh.vertices[mesh.faces[flat[0]][0]]) + ": remesh the surface");
  const auto crossings = self_intersections(mesh);
  if (!crossings.empty())
    throw InvalidInput(counted(crossings.size(), "pair", "pairs") + " of crossing faces, the first at " +
                       point_text(mesh.vertices[mesh.faces[crossings[0].first][0]]) +
                       ": the surface does not bound a volume");
}

class FrameBuilder {
 public:
  explicit FrameBuilder(const VesselWall& wall) : wall_(wall), number_(wall.mesh.vertices.size(), kNone) {}

  WallFrame run() {
    add_wall();
    std::vector<std::vector<Index>> faces_of(wall_.patch_names.size());
    for (Index f = 0; f < wall_.patch.size(); ++f) faces_of[wall_.patch[f]].push_back(f);
    for (Index patch = wall_.wall_patches; patch < faces_of.size(); ++patch) {
      if (!faces_of[patch].empty()) add_cap(patch, faces_of[patch]);
    }
    return std::move(frame_);
  }

 private:
  void add_wall() {
    std::vector<char> is_of_wall(number_.size(), 0);
    for (Index f = 0; f < wall_.patch.size(); ++f) {
      if (!wall_.is_wall(f)) continue;
      for (const Index v : wall_.mesh.faces[f]) is_of_wall[v] = 1;
    }
    for (Index v = 0; v < number_.size(); ++v) {
      if (!is_of_wall[v]) continue;
      number_[v] = static_cast<Index>(frame_.position.size());
      frame_.position.push_back(wall_.mesh.vertices[v]);
      frame_.radius.push_back(wall_.radius[v]);
    }
    if (frame_.position.empty()) throw InvalidInput("the surface has no faces of the wall, only caps");
    frame_.fan.resize(frame_.position.size());
    frame_.cap_at.assign(frame_.position.size(), kNone);
    for (Index f = 0; f < wall_.patch.size(); ++f) {
      if (!wall_.is_wall(f)) continue;
      const auto& [a, b, c] = wall_.mesh.faces[f];
      for (const Index v : {a, b, c}) frame_.fan[number_[v]].push_back(static_cast<Index>(frame_.faces.size()));
      frame_.faces.push_back({number_[a], number_[b], number_[c]});
    }
  }

  void add_cap(Index patch, const std::vector<Index>& faces) {
    Cap cap;
    cap.patch = patch;
    const std::vector<Index> rim = rim_of(patch, faces);
    cap.disc = disc_of(rim, faces);
    Vec3 area = Vec3::Zero();
    for (const Index f : faces) area += area_normal(wall_.mesh, f) / 2;
    cap.normal = area.normalized();
    cap.unevenness = unevenness(faces, cap.normal);
    if (cap.unevenness > kMostUneven * std::sqrt(area.norm()))
      throw InvalidInput(
          name(patch) + " is not flat: " + formatted("its vertices differ from a plane by %g mm", cap.unevenness) +
          ", near " + point_text(wall_.mesh.vertices[rim[0]]) + "; vmesh generate --ends flat makes flat ones");
    for (const Index v : rim) claim(v, patch);
    for (const Index v : rim) cap.rim.push_back(number_[v]);
    frame_.caps.push_back(std::move(cap));
  }

  void claim(Index v, Index patch) {
    const auto other = number_[v] == kNone ? kNone : frame_.cap_at[number_[v]];
    if (number_[v] == kNone || other != kNone)
      throw InvalidInput(name(patch) + " touches another cap at " + point_text(wall_.mesh.vertices[v]) +
                         "; there must be a wall between them");
    frame_.cap_at[number_[v]] = static_cast<Index>(frame_.caps.size());
  }

  // Along the edges that have one face in the patch.
  std::vector<Index> rim_of(Index patch, const std::vector<Index>& faces) const {
    TriMesh part;
    part.vertices.resize(number_.size());
    for (const Index f : faces) part.faces.push_back(wall_.mesh.faces[f]);
    std::map<Index, Index> next;
    const auto edges = boundary_edges(part);
    for (const auto& [from, to] : edges) next[from] = to;
    std::vector<Index> rim;
    const Index first = edges.empty() ? kNone : edges.front()[0];
    for (Index v = first; v != kNone && (rim.empty() || v != first) && rim.size() <= edges.size(); v = next.at(v))
      rim.push_back(v);
    if (rim.size() < 3 || rim.size() != edges.size() || next.size() != edges.size())
      throw InvalidInput(name(patch) + " is not a disc: its border must be one closed line");
    return rim;
  }

  Disc disc_of(const std::vector<Index>& rim, const std::vector<Index>& faces) const {
    Disc disc;
    std::map<Index, Index> number;
    for (const Index v : rim) number.emplace(v, static_cast<Index>(number.size()));
    for (const Index f : faces) {
      Triangle triangle = wall_.mesh.faces[f];
      for (Index& v : triangle) {
        const auto [entry, is_new] = number.emplace(v, static_cast<Index>(number.size()));
        if (is_new) disc.vertices.push_back(wall_.mesh.vertices[v]);
        v = entry->second;
      }
      disc.faces.push_back(triangle);
    }
    return disc;
  }

  double unevenness(const std::vector<Index>& faces, const Vec3& normal) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Index f : faces) {
      for (const Index v : wall_.mesh.faces[f]) {
        const double height = normal.dot(wall_.mesh.vertices[v] - wall_.mesh.vertices[wall_.mesh.faces[faces[0]][0]]);
        low = std::min(low, height);
        high = std::max(high, height);
      }
    }
    return high - low;
  }

  std::string name(Index patch) const { return "the patch " + wall_.patch_names[patch]; }

  const VesselWall& wall_;
  std::vector<Index> number_;  // of every vertex of the surface, in the frame
  WallFrame frame_;
};

}  // namespace

WallFrame frame_of(const VesselWall& wall) {
  check_sizes(wall);
  check_surface(wall.mesh);
  return FrameBuilder(wall).run();
}

std::vector<Vec3> face_normals(const WallFrame& frame) {
  std::vector<Vec3> normals;
  normals.reserve(frame.faces.size());
  for (const auto& [a, b, c] : frame.faces) {
    const Vec3& p = frame.position[a];
    normals.push_back((frame.position[b] - p).cross(frame.position[c] - p).normalized());
  }
  return normals;
}

}  // namespace vmesh

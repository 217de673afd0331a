#include "vmesh/parts/join.h"

#include <algorithm>
#include <sstream>

#include <tbb/task_arena.h>

#include "vmesh/core/ascending.h"
#include "vmesh/core/error.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/branch_labels.h"

#include "parts/part_index.h"

namespace vmesh {
namespace {

Vec3 area_normal(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a); }

// Vertices in columns, as passed to a sink.
struct Columns {
  std::vector<Vec3> position, normal;
  std::vector<double> radius;
  std::vector<SimplifiedCenterline::Place> place;
  std::vector<Index> branch;

  void resize(std::size_t count) {
    position.resize(count);
    normal.assign(count, Vec3::Zero());
    radius.resize(count);
    place.resize(count);
    branch.resize(count);
  }
  std::size_t size() const { return position.size(); }
  void normalize() {
    for (Vec3& n : normal) {
      const double norm = n.norm();
      if (norm > 0) n /= norm;
    }
  }
  SurfaceSink::Vertices from(std::size_t first) const {
    return {std::span(position).subspan(first), std::span(normal).subspan(first), std::span(radius).subspan(first),
            std::span(place).subspan(first), std::span(branch).subspan(first)};
  }
};

// A part as it is in the whole surface, after parting walls.
struct LoadedPart {
  Columns vertices;             // of its seams, then its own
  std::vector<Index> number;    // in the whole
  std::vector<Triangle> faces;  // indices into `vertices`, then into the added ones
  std::size_t seam_vertices = 0;
};

class Joiner {
 public:
  Joiner(const PartIndex& index, const PartedWalls& walls, SurfaceSink& sink, const Progress& progress)
      : index_(index), walls_(walls), sink_(sink), progress_(progress) {}

  void run(JoinSummary& summary) {
    added_.resize(walls_.added.size());
    for (std::size_t i = 0; i < walls_.added.size(); ++i) set(added_, i, walls_.added[i]);
    collect_seams();
    sink_.begin(summary.vertices, summary.faces);
    sink_.add(seams_.from(0));
    for (std::size_t p = 0; p < index_.parts.size(); ++p) {
      tell("write vertices", p);
      LoadedPart part = load(p);
      add_normals(part, [&](std::size_t v, const Vec3& normal) {
        if (v < part.vertices.size()) part.vertices.normal[v] += normal;
      });
      part.vertices.normalize();
      sink_.add(part.vertices.from(part.seam_vertices));
    }
    if (added_.size() > 0) {
      added_.normalize();
      sink_.add(added_.from(0));
    }
    for (std::size_t p = 0; p < index_.parts.size(); ++p) {
      tell("write faces", p);
      const LoadedPart part = load(p);
      write_faces(part, summary);
    }
    write_added_faces(summary);
    summary.mean_skewness = sum_ / static_cast<double>(std::max<std::size_t>(1, summary.faces));
  }

 private:
  void tell(const char* stage, std::size_t part) {
    report_progress(progress_, stage, static_cast<double>(part) / static_cast<double>(index_.parts.size()));
  }

  static void set(Columns& columns, std::size_t i, const PartedWalls::Vertex& v) {
    columns.position[i] = v.position;
    columns.radius[i] = v.radius;
    columns.place[i] = v.place;
    columns.branch[i] = v.branch;
  }

  LoadedPart load(std::size_t p) const {
    StoredPartSurface stored = read_part_surface(index_.parts[p].surface, false);
    PartSurface& surface = stored.surface;
    LoadedPart part;
    part.seam_vertices = surface.seam_vertex_count();
    const std::size_t count = surface.mesh.vertices.size();
    for (Index v = 0; v < count; ++v) part.number.push_back(index_.vertex(p, surface, v));
    part.vertices.position = std::move(surface.mesh.vertices);
    part.vertices.radius = std::move(surface.radius);
    part.vertices.place = std::move(stored.place);
    part.vertices.branch = std::move(stored.branch);
    part.vertices.normal.assign(count, Vec3::Zero());
    part.faces = std::move(surface.mesh.faces);
    if (walls_.moved.empty() && walls_.changed.empty() && walls_.added_faces.empty()) return part;
    for (std::size_t v = 0; v < count; ++v) {
      const auto it = std::lower_bound(walls_.moved.begin(), walls_.moved.end(), part.number[v],
                                       [](const PartedWalls::Vertex& m, Index n) { return m.number < n; });
      if (it != walls_.moved.end() && it->number == part.number[v]) set(part.vertices, v, *it);
    }
    const Index first = index_.parts[p].first_face;
    for (const auto& [f, corners] : walls_.changed) {
      if (f < first || f >= first + part.faces.size()) continue;
      for (std::size_t k = 0; k < 3; ++k) part.faces[f - first][k] = place_in(part, corners[k]);
    }
    return part;
  }

  // Numbers ascend in a part: its seams', then its own.
  Index place_in(const LoadedPart& part, Index number) const {
    if (number >= index_.vertices) return static_cast<Index>(part.vertices.size() + number - index_.vertices);
    return vmesh::place_in(part.number, number);
  }

  const Vec3& position(const LoadedPart& part, Index v) const {
    return v < part.vertices.size() ? part.vertices.position[v] : added_.position[v - part.vertices.size()];
  }

  // Calls add(place, normal) at every corner, faces in their order in the whole.
  template <class Add>
  void add_normals(const LoadedPart& part, Add&& add) const {
    const auto add_face = [&](const Triangle& f) {
      const Vec3 normal = area_normal(position(part, f[0]), position(part, f[1]), position(part, f[2]));
      for (const Index v : f) add(v, normal);
    };
    for (const Triangle& f : part.faces) add_face(f);
    for (const Triangle& f : walls_.added_faces) {
      const Triangle here = {place_in(part, f[0]), place_in(part, f[1]), place_in(part, f[2])};
      if (std::find(here.begin(), here.end(), kNone) == here.end()) add_face(here);
    }
  }

  // Collects seam vertices, and what faces contribute to their normals and those of added vertices: part by part, then
  // added faces.
  void collect_seams() {
    seams_.resize(index_.manifest.seams * index_.manifest.around);
    for (std::size_t p = 0; p < index_.parts.size(); ++p) {
      tell("seams", p);
      const LoadedPart part = load(p);
      for (std::size_t v = 0; v < part.seam_vertices; ++v) {
        const Index n = part.number[v];
        seams_.position[n] = part.vertices.position[v];
        seams_.radius[n] = part.vertices.radius[v];
        seams_.place[n] = part.vertices.place[v];
        seams_.branch[n] = part.vertices.branch[v];
      }
      for (const Triangle& f : part.faces) {
        if (std::none_of(f.begin(), f.end(), [&](Index v) { return is_shared(part, v); })) continue;
        const Vec3 normal = area_normal(position(part, f[0]), position(part, f[1]), position(part, f[2]));
        for (const Index v : f) {
          if (is_shared(part, v)) shared_normal(part, v) += normal;
        }
      }
      remember_corners(part);
    }
    for (std::size_t f = 0; f < walls_.added_faces.size(); ++f) {
      const std::array<Vec3, 3>& p = corners_[f];
      const Vec3 normal = area_normal(p[0], p[1], p[2]);
      for (const Index v : walls_.added_faces[f]) {
        if (v < seams_.size()) seams_.normal[v] += normal;
        if (v >= index_.vertices) added_.normal[v - index_.vertices] += normal;
      }
    }
    seams_.normalize();
  }

  static bool is_shared(const LoadedPart& part, Index v) { return v < part.seam_vertices || v >= part.vertices.size(); }
  Vec3& shared_normal(const LoadedPart& part, Index v) {
    return v < part.seam_vertices ? seams_.normal[part.number[v]] : added_.normal[v - part.vertices.size()];
  }

  // Remembers the corners of added faces and their branches.
  void remember_corners(const LoadedPart& part) {
    corners_.resize(walls_.added_faces.size());
    labels_.resize(walls_.added_faces.size());
    for (std::size_t f = 0; f < corners_.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Index v = place_in(part, walls_.added_faces[f][k]);
        if (v == kNone) continue;
        corners_[f][k] = position(part, v);
        labels_[f][k] = branch(part, v);
      }
    }
  }

  Index branch(const LoadedPart& part, Index v) const {
    return v < part.vertices.size() ? part.vertices.branch[v] : added_.branch[v - part.vertices.size()];
  }

  void write_faces(const LoadedPart& part, JoinSummary& summary) {
    std::vector<Triangle> corners;
    std::vector<double> skewness;
    std::vector<Index> label;
    corners.reserve(part.faces.size());
    for (const Triangle& f : part.faces) {
      Triangle numbers = f;
      for (Index& v : numbers)
        v = v < part.vertices.size() ? part.number[v] : static_cast<Index>(index_.vertices + v - part.vertices.size());
      corners.push_back(numbers);
      skewness.push_back(equiangle_skewness(position(part, f[0]), position(part, f[1]), position(part, f[2])));
      label.push_back(label_of_face(branch(part, f[0]), branch(part, f[1]), branch(part, f[2])));
      count(skewness.back(), summary);
    }
    sink_.add({corners, skewness, label});
  }

  void write_added_faces(JoinSummary& summary) {
    if (walls_.added_faces.empty()) return;
    std::vector<double> skewness;
    std::vector<Index> label;
    for (std::size_t f = 0; f < walls_.added_faces.size(); ++f) {
      skewness.push_back(equiangle_skewness(corners_[f][0], corners_[f][1], corners_[f][2]));
      label.push_back(label_of_face(labels_[f][0], labels_[f][1], labels_[f][2]));
      count(skewness.back(), summary);
    }
    sink_.add({walls_.added_faces, skewness, label});
  }

  void count(double skewness, JoinSummary& summary) {
    sum_ += skewness;
    summary.max_skewness = std::max(summary.max_skewness, skewness);
  }

  const PartIndex& index_;
  const PartedWalls& walls_;
  SurfaceSink& sink_;
  const Progress& progress_;
  Columns seams_, added_;
  std::vector<std::array<Vec3, 3>> corners_;  // of added faces
  std::vector<std::array<Index, 3>> labels_;
  double sum_ = 0;
};

// Adds defects for pairs of faces that still cross.
void add_crossings_left(const PartIndex& index, const PartedWalls& walls, std::vector<JoinDefect>& defects) {
  for (const auto& [f, g] : walls.left) {
    const PieceBox& box = index.boxes[index.piece_of_face(f)];
    const Vec3 middle = (box.low + box.high) / 2;
    std::ostringstream text;
    text << "walls of pieces " << index.piece_of_face(f) << " and " << index.piece_of_face(g) << " cross, near ("
         << middle.x() << ", " << middle.y() << ", " << middle.z() << ")";
    defects.push_back({DefectKind::crossing_faces, middle, text.str()});
  }
}

void check_topology(JoinSummary& summary) {
  const auto components = static_cast<std::int64_t>(summary.growth.components);
  const auto loops = static_cast<std::int64_t>(summary.growth.cycle_rank);
  if (summary.faces % 2 == 0 && summary.euler_characteristic == 2 * (components - loops)) return;
  summary.defects.push_back({DefectKind::wrong_topology, Vec3::Zero(),
                             "the Euler characteristic is " + std::to_string(summary.euler_characteristic) + " where " +
                                 std::to_string(2 * (components - loops)) + " is expected"});
}

}  // namespace

JoinSummary join_parts(const std::filesystem::path& folder, SurfaceSink& sink, int threads, const Progress& progress) {
  JoinSummary summary;
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] {
    const PartIndex index = index_parts(folder, progress);
    summary.manifest = index.manifest;
    summary.growth = index.growth;
    std::vector<std::pair<Index, Index>> crossings = crossings_between_parts(index, progress);
    crossings.insert(crossings.end(), index.crossings.begin(), index.crossings.end());
    std::sort(crossings.begin(), crossings.end());
    PartedWalls walls;
    if (!crossings.empty()) walls = part_crossing_walls(index, crossings);
    summary.walls_parted = crossings.size() - walls.left.size();
    add_crossings_left(index, walls, summary.defects);
    summary.vertices = index.vertices + walls.added.size();
    summary.faces = index.faces + walls.added_faces.size();
    summary.euler_characteristic =  // every edge has two faces
        static_cast<std::int64_t>(summary.vertices) - static_cast<std::int64_t>(summary.faces / 2);
    check_topology(summary);
    if (!summary.is_sound()) return;
    Joiner(index, walls, sink, progress).run(summary);
  });
  return summary;
}

}  // namespace vmesh

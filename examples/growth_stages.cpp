// Writes the stages of growth before there is a surface, for pictures (libvmesh/README.md): skeleton.ply, rings.ply and
// lattice.ply. Uses internal headers that are not installed.
//   growth_stages [CENTERLINE [FOLDER]]
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <span>

#include "vmesh/core/error.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/contacts.h"

#include "surface/junction/junction_growth.h"
#include "surface/pieces/division.h"
#include "surface/tubes/stitch.h"

namespace {

using namespace vmesh;

// A mesh whose faces have a group, which `vmesh render --color group` shows in different colours.
class Drawing {
 public:
  void add(const std::vector<Vec3>& vertices, const std::vector<Triangle>& faces, int group) {
    const auto first = static_cast<Index>(mesh_.vertices.size());
    mesh_.vertices.insert(mesh_.vertices.end(), vertices.begin(), vertices.end());
    for (const auto& [a, b, c] : faces) {
      mesh_.faces.push_back({first + a, first + b, first + c});
      groups_.push_back(group);
    }
  }

  // A closed prism around a line.
  void add_line(const Vec3& a, const Vec3& b, double radius, int group) {
    constexpr Index kSides = 8;
    if ((b - a).norm() < 1e-9) return;
    const Vec3 along = (b - a).normalized(), side = along.unitOrthogonal(), up = along.cross(side);
    std::vector<Vec3> vertices;
    std::vector<Triangle> faces;
    for (const Vec3& end : {a, b}) {
      for (Index i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        vertices.push_back(end + radius * (std::cos(angle) * side + std::sin(angle) * up));
      }
    }
    for (Index i = 0; i < kSides; ++i) {
      const Index next = (i + 1) % kSides;
      faces.push_back({i, next, kSides + i});
      faces.push_back({next, kSides + next, kSides + i});
      if (i > 0 && next > 0) {
        faces.push_back({0, next, i});
        faces.push_back({kSides, kSides + i, kSides + next});
      }
    }
    add(vertices, faces, group);
  }

  void add_loop(const std::vector<Vec3>& points, double radius, int group) {
    for (std::size_t i = 0; i < points.size(); ++i) add_line(points[i], points[(i + 1) % points.size()], radius, group);
  }

  void write(const std::filesystem::path& file) const {
    MeshAttributes attributes;
    attributes.face.push_back({"group", groups_, true});
    write_surface(file, mesh_, attributes);
    std::printf("%s\n", file.c_str());
  }

 private:
  TriMesh mesh_;
  std::vector<double> groups_;
};

// Colours of the pictures.
enum Group { kTube = 0, kJunction = 1, kSeam = 2 };
constexpr double kLine = 0.08;  // radii of the vessel, half the width of lines
constexpr double kAxis = 0.15;  // the same for axes

std::vector<Vec3> positions(std::span<const RingPoint> points) {
  std::vector<Vec3> result;
  for (const RingPoint& p : points) result.push_back(p.position);
  return result;
}

// The outline of a ring; a ring that is not free may lack points.
std::vector<Vec3> outline(const Ring& ring) {
  if (!ring.points.empty()) return positions(ring.points);
  const Vec3 side = ring.normal.unitOrthogonal(), up = ring.normal.cross(side);
  std::vector<Vec3> circle;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2 * std::numbers::pi * i / 24;
    circle.push_back(ring.center + ring.radius * (std::cos(angle) * side + std::sin(angle) * up));
  }
  return circle;
}

void draw_axis(const BranchAxis& axis, double begin, double end, int group, Drawing& drawing) {
  constexpr int kSteps = 40;
  for (int i = 0; i < kSteps; ++i) {
    const auto a = axis.at(begin + (end - begin) * i / kSteps), b = axis.at(begin + (end - begin) * (i + 1) / kSteps);
    drawing.add_line(a.position, b.position, kAxis * a.radius, group);
  }
}

// The extent of a tube on its branch; a cap extends it to the tip.
std::pair<double, double> reach_of(const Tube& tube, const BranchAxis& axis) {
  const double begin = tube.starts_at_tip ? 0 : tube.rings.front().place;
  const double end = tube.ends_at_tip || tube.periodic ? axis.length() : tube.rings.back().place;
  return {begin, end < begin ? end + axis.length() : end};
}

// The graph that steers growth, along the axes of the vessels: tubes, junctions, and the seams between pieces.
Drawing draw_skeleton(const VesselRings& tubes, const Division& division,
                      const std::vector<GrowthSkeleton>& skeletons) {
  Drawing drawing;
  for (const GrowthSkeleton& skeleton : skeletons) {
    for (const Tube& tube : skeleton.tubes) {
      const BranchAxis& axis = tubes.axes()[tube.branch];
      const auto [begin, end] = reach_of(tube, axis);
      draw_axis(axis, begin, end, kTube, drawing);
    }
    for (const Junction& junction : skeleton.junctions) {
      for (const BareStretch& bare : junction.bare_stretches)
        draw_axis(tubes.axes()[bare.branch], bare.begin, bare.end, kJunction, drawing);
    }
  }
  for (const RingPlace& seam : division.seams) {
    const Ring& ring = tubes.rings(seam.branch)[seam.ring];
    drawing.add_loop(outline(ring), kLine * ring.radius, kSeam);
  }
  return drawing;
}

// All rings as laid: free ones, seams among them, and those left to junctions.
Drawing draw_rings(const VesselRings& tubes, const Division& division) {
  Drawing drawing;
  for (Index b = 0; b < tubes.axes().size(); ++b) {
    const std::span<const Ring> rings = tubes.rings(b);
    for (Index k = 0; k < rings.size(); ++k) {
      const bool is_seam = std::binary_search(division.seams.begin(), division.seams.end(), RingPlace{b, k});
      const int group = is_seam ? kSeam : rings[k].free ? kTube : kJunction;
      drawing.add_loop(outline(rings[k]), kLine * rings[k].radius, group);
    }
  }
  return drawing;
}

void draw_tube(const Tube& tube, Drawing& drawing) {
  const std::size_t count = tube.rings.size();
  for (std::size_t k = 0; k + 1 < count + (tube.periodic ? 1 : 0); ++k) {
    const std::vector<Vec3> ring = positions(tube.rings[k].points),
                            next = positions(tube.rings[(k + 1) % count].points);
    std::vector<Vec3> both = ring;
    both.insert(both.end(), next.begin(), next.end());
    drawing.add(both, stitch(ring, next), kTube);
  }
}

// Every junction's surface as it comes out of its lattice, and the rings of the tubes, joined by bands.
Drawing draw_lattice(const VesselRings& tubes, const std::vector<GrowthSkeleton>& skeletons,
                     const GenerateOptions& options) {
  Drawing drawing;
  for (const GrowthSkeleton& skeleton : skeletons) {
    for (const Tube& tube : skeleton.tubes) draw_tube(tube, drawing);
    for (const Junction& junction : skeleton.junctions) {
      const JunctionGrowth growth(tubes.field(), tubes.axes(), skeleton, junction, options);
      drawing.add(growth.lattice().vertices, growth.lattice().faces, kJunction);
    }
  }
  return drawing;
}

void draw_stages(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const GenerateOptions options;
  const Centerline separated = separate_contacts(load_centerline(file).cleaned.centerline).centerline;
  const Centerline centerline = simplify_for_growth(separated, options).centerline;
  const VesselField field(centerline, options.blend);
  const VesselRings tubes(field, {options.around, options.placement, options.max_error});
  const Division division = divide(tubes, options);
  std::vector<GrowthSkeleton> skeletons;
  for (const PiecePlan& plan : division.plans) skeletons.push_back(make_growth_skeleton(tubes, plan));
  std::filesystem::create_directories(folder);
  draw_skeleton(tubes, division, skeletons).write(folder / "skeleton.ply");
  draw_rings(tubes, division).write(folder / "rings.ply");
  draw_lattice(tubes, skeletons, options).write(folder / "lattice.ply");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    draw_stages(argc > 1 ? argv[1] : "small_tree.swc", argc > 2 ? argv[2] : "stages");
  } catch (const Error& error) {
    std::fprintf(stderr, "growth_stages: %s\n", error.what());
    return 1;
  }
}

// Volume meshes around centerlines, over files and over random trees: a table in Markdown, and one closing line. Usage:
//   bench_volume [--round] [--around N] [--layers N] [--shell N] [--merge] [--wall-only] [--rotate] [--all] [FILE...]
//   [--follow] [--plausible FIRST COUNT]
// A file is a centerline, or a surface of vmesh generate with radii. Ends are flat unless --round. --rotate makes each
// random tree with the next of a list of options for its surface and its layers; of random trees, only those that were
// refused are listed, unless --all. A case that is not sound, or is refused without a place, makes the exit code 1.
// With --follow, a mesh that was made around a centerline also follows eight studies, stenoses and aneurysms of half of
// the diameter around nodes all over the vessels; those that it cannot follow are listed.
// Options apply to what follows them.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/production/produce.h"
#include "vmesh/solid/followed_volume.h"
#include "vmesh/solid/make_volume.h"
#include "vmesh/surface/surface_attributes.h"

#include "random_vessels.h"
#include "rotated_options.h"

namespace {

using namespace vmesh;

struct Settings {
  bool all = false, rotate = false, follow = false;
  ProductionOptions production;
  VolumeOptions volume;
};

struct Tally {
  std::size_t cases = 0, unsound_surfaces = 0, refused = 0, failed = 0;
  std::size_t studies = 0, not_followed = 0, only_inverted = 0;  // of the latter, those of sound boundaries
  double least_dihedral = 180, least_followed = 180, seconds = 0;
};

constexpr Index kStudies = 8;  // of each mesh

/// In turn, with another period than that of rotated_options().
VolumeOptions rotated_volume(std::uint32_t seed) {
  VolumeOptions options;
  switch (seed % 7) {
    case 1:
      options.layers.count = 1;
      break;
    case 2:
      options.layers.count = 0;
      break;
    case 3:
      options.layers = {.count = 8, .thickness = 0.4, .growth = 1.3};
      break;
    case 4:
      options.shell.count = 2;
      break;
    case 5:
      options.layers.first_mm = 0.02;
      break;
    case 6:
      options.core_size = 0.5;
      break;
    default:
      break;
  }
  return options;
}

VesselWall wall_of(const Production& production, const Centerline& centerline) {
  const GenerateResult& result = production.result;
  MeshAttributes attributes =
      surface_attributes(result.mesh, result.binding, result.radius, result.openings, centerline);
  if (!production.ends.ends.empty()) add_cap_labels(production.ends, attributes);
  return vessel_wall(result.mesh, attributes);
}

void print(const std::string& name, const VesselWall& wall, const VolumeResult& result, double seconds) {
  const VolumeMeasures measures = measure_volume(result.mesh);
  std::printf(
      "| %s | %zu | %zu | %zu | %zu | %.1f / %.2f | %.1f | %.1f | %.3f / %.3f | %.3f | (%.2f %.2f %.2f) | %.3f |",
      name.c_str(), wall.mesh.faces.size(), result.mesh.wedges.size(), result.mesh.pyramids.size(),
      result.mesh.tetrahedra.size(), 100 * result.layers.full_share, result.layers.least_share,
      measures.min_dihedral_deg, measures.max_dihedral_deg, measures.least_radius_ratio, measures.mean_radius_ratio,
      measures.least_scaled_jacobian, measures.worst_tetrahedron.x(), measures.worst_tetrahedron.y(),
      measures.worst_tetrahedron.z(), seconds);
  for (const VolumeDefect& defect : result.defects) std::printf(" %s;", defect.message.c_str());
  std::printf("\n");
  std::fflush(stdout);
}

VolumeResult mesh_wall(const std::string& name, const VesselWall& wall, const VolumeOptions& options, bool show,
                       Tally& tally) {
  const std::clock_t start = std::clock();
  const VolumeResult result = make_volume(wall, options);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  tally.seconds += seconds;
  tally.refused += !result.is_sound();
  for (const VolumeDefect& defect : result.defects) tally.failed += defect.kind != VolumeDefectKind::not_filled;
  if (result.is_sound())
    tally.least_dihedral = std::min(tally.least_dihedral, measure_volume(result.mesh).min_dihedral_deg);
  if (show || !result.is_sound()) print(name, wall, result, seconds);
  return result;
}

/// Around a node: eight of its radii long.
CenterlineEdit study(const Centerline& centerline, Index number) {
  const auto nodes = static_cast<Index>(centerline.nodes().size());
  const Index node = number * nodes / kStudies;
  return {{{node, 8 * centerline.node(node).radius, number % 2 == 0 ? -0.5 : 0.5}}};
}

void follow_studies(const std::string& name, const Centerline& centerline, const VolumeMesh& mesh, Tally& tally) {
  for (Index number = 0; number < kStudies; ++number) {
    const CenterlineEdit edit = study(centerline, number);
    VolumeMesh moved = mesh;
    moved.points = follow_edit(mesh, centerline, edit);
    const std::vector<VolumeDefect> defects = find_volume_defects(moved);
    ++tally.studies;
    if (defects.empty()) {
      tally.least_followed = std::min(tally.least_followed, measure_volume(moved).min_dihedral_deg);
      continue;
    }
    ++tally.not_followed;
    tally.only_inverted += defects.size() == 1 && defects[0].kind == VolumeDefectKind::inverted_cell;
    std::printf("| %s | study %u, at node %u, share %g |", name.c_str(), number, edit.radius[0].node,
                edit.radius[0].share);
    for (const VolumeDefect& defect : defects) std::printf(" %s;", defect.message.c_str());
    std::printf("\n");
  }
}

/// Does `work`, which is for one case. What is thrown has no place, and so is a failure.
template <class Work>
void examine(const std::string& name, Tally& tally, const Work& work) {
  ++tally.cases;
  try {
    work();
  } catch (const std::exception& error) {
    ++tally.refused;
    ++tally.failed;
    std::printf("| %s | refused: %s |\n", name.c_str(), error.what());
  }
}

void examine_centerline(const std::string& name, const Centerline& centerline,
                        const ProductionOptions& production_options, const VolumeOptions& options, bool show,
                        bool follow, Tally& tally) {
  examine(name, tally, [&] {
    const Production production = produce(centerline, {}, production_options);
    if (production.result.is_sound()) {
      const VolumeResult result = mesh_wall(name, wall_of(production, centerline), options, show, tally);
      if (follow && result.is_sound()) follow_studies(name, centerline, result.mesh, tally);
    } else {
      ++tally.unsound_surfaces;
    }
  });
}

void examine_file(const std::string& path, const Settings& settings, Tally& tally) {
  const std::string name = path.substr(path.rfind('/') + 1);
  try {
    if (find_surface_format(path)) {
      LoadedSurface surface = read_surface(path);
      if (find_attribute(surface.attributes.vertex, "radius")) {
        const VesselWall wall = vessel_wall(std::move(surface.mesh), surface.attributes);
        return examine(name, tally, [&] { mesh_wall(name, wall, settings.volume, true, tally); });
      }
    }
    examine_centerline(name, load_centerline(path).cleaned.centerline, settings.production, settings.volume, true,
                       settings.follow, tally);
  } catch (const std::exception& error) {
    std::printf("| %s | not read: %s |\n", path.c_str(), error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  settings.production.ends = EndShape::flat;
  Tally tally;
  std::printf(
      "| case | faces | wedges | pyramids | tetrahedra | full layers, %% of the wall / least | least angle | largest | "
      "radius ratio "
      "least / mean | least Jacobian of wedges | worst tetrahedron | CPU, s | defects "
      "|\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|--:|---|\n");
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--all") {
      settings.all = true;
    } else if (word == "--follow") {
      settings.follow = true;
    } else if (word == "--rotate") {
      settings.rotate = true;
    } else if (word == "--round") {
      settings.production.ends = EndShape::round;
    } else if (word == "--around" && i + 1 < argc) {
      settings.production.growth.around = std::atoi(argv[++i]);
    } else if (word == "--layers" && i + 1 < argc) {
      settings.volume.layers.count = std::atoi(argv[++i]);
    } else if (word == "--merge") {
      settings.volume.shell.merged = true;
    } else if (word == "--wall-only") {
      settings.volume.shell_only = true;
    } else if (word == "--shell" && i + 1 < argc) {
      settings.volume.shell.count = std::atoi(argv[++i]);
    } else if (word == "--plausible" && i + 2 < argc) {
      const auto first = static_cast<std::uint32_t>(std::atoi(argv[i + 1]));
      const auto count = static_cast<std::uint32_t>(std::atoi(argv[i + 2]));
      for (std::uint32_t seed = first; seed < first + count; ++seed) {
        ProductionOptions production = settings.production;
        if (settings.rotate) {
          production.growth = testing::rotated_options(seed);
          production.growth.open_ends = {};
        }
        examine_centerline("plausible_" + std::to_string(seed), testing::plausible_tree(seed), production,
                           settings.rotate ? rotated_volume(seed) : settings.volume, settings.all, settings.follow,
                           tally);
      }
      i += 2;
    } else {
      examine_file(word, settings, tally);
    }
  }
  std::printf(
      "\n%zu cases, %zu surfaces not sound, %zu meshes refused, %zu of them wrong; least angle %.2f degrees; %.1f s of "
      "CPU\n",
      tally.cases, tally.unsound_surfaces, tally.refused, tally.failed, tally.least_dihedral, tally.seconds);
  if (tally.studies > 0)
    std::printf(
        "%zu studies, %zu not followed, %zu of them because cells turn over within a sound boundary; least angle "
        "of the others %.2f degrees\n",
        tally.studies, tally.not_followed, tally.only_inverted, tally.least_followed);
  return tally.failed > 0 ? 1 : 0;
}

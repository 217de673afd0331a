// The guaranteed Hausdorff distance against CGAL's bounded-error one, and against VTK's distance at vertices, on the
// same pairs in one run, one thread each, CPU time and memory. Prints a table in Markdown. Pairs come from the shared
// test data: surfaces with their own decimation to 13 % of the edges, and with a grown surface.
//
//   bench_hausdorff [--runs N] [--ours]
#include "vmesh/quality/hausdorff.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>

#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "peers.h"

namespace {

using namespace vmesh;

constexpr double kTolerance = 1e-4;    // mm
constexpr double kKept = 0.13;         // of the edges
constexpr double kGridSpacing = 0.71;  // mm; gives the liver-like tree about 178,000 faces

struct Pair {
  std::string name, other_name;
  TriMesh fine, coarse;
};

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Cost {
  double ms = 0;  // median
  double mb = 0;  // peak memory above that at the start
};

// Peak memory of a child process that runs `work`, MB.
double peak_mb(const std::function<void()>& work) {
  malloc_trim(0);
  const pid_t child = fork();
  if (child == 0) {
    work();
    _exit(0);
  }
  rusage usage{};
  wait4(child, nullptr, 0, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

Cost measure(int runs, const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < runs; ++i) {
    const double start = cpu_seconds();
    work();
    times.push_back(1e3 * (cpu_seconds() - start));
  }
  std::nth_element(times.begin(), times.begin() + runs / 2, times.end());
  return {times[static_cast<std::size_t>(runs / 2)], peak_mb(work) - peak_mb([] {})};
}

Pair decimated_pair(const std::string& name, const std::string& other_name, const TriMesh& surface) {
  const bench::CgalMesh fine(surface);
  return {name, other_name, fine.mesh(), fine.decimated(kKept)};
}

TriMesh isosurface(const Centerline& centerline) {
  const VesselField field(centerline);
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const CenterlineNode& node : centerline.nodes()) {
    low = low.cwiseMin(node.position - Vec3::Constant(node.radius + 2 * kGridSpacing));
    high = high.cwiseMax(node.position + Vec3::Constant(node.radius + 2 * kGridSpacing));
  }
  const auto value = [](const Vec3& p, const void* context) {
    return static_cast<const VesselField*>(context)->sample_global(p).distance;
  };
  return bench::vtk_isosurface(low, high, kGridSpacing, value, &field);
}

// Marching cubes of a tree's vessels, decimated and against the surface that vmesh grows.
void add_tree_pairs(const std::filesystem::path& centerline_file, std::vector<Pair>& pairs) {
  const LoadedCenterline loaded = load_centerline(centerline_file);
  const Centerline& centerline = loaded.cleaned.centerline;
  pairs.push_back(decimated_pair("marching cubes of tree1560", "decimated", isosurface(centerline)));
  pairs.push_back({pairs.back().name, "grown", pairs.back().fine, generate_surface(centerline).mesh});
}

std::vector<Pair> load_pairs(const std::filesystem::path& data) {
  std::vector<Pair> pairs;
  const auto tree = data / "synthetic_trees/tree1560.swc";
  if (bench::have_vtk() && std::filesystem::exists(tree)) {
    add_tree_pairs(tree, pairs);
  } else {
    std::fprintf(stderr, "skipped, VTK or data are missing: %s\n", tree.c_str());
  }
  for (const auto& [name, file] :
       {std::pair{"SPL portal vein", "liver_spl_atlas/spl_portal_vein_combined.ply"},
        std::pair{"aorta", "pairs_centerline_surface/aorta-surface.stl"},
        std::pair{"coronary tree", "surfaces_other/extract-faces_python_coronarytree.stl"}}) {
    if (std::filesystem::exists(data / file)) {
      pairs.push_back(decimated_pair(name, "decimated", read_surface(data / file).mesh));
    } else {
      std::fprintf(stderr, "skipped, data are missing: %s\n", (data / file).c_str());
    }
  }
  return pairs;
}

struct Settings {
  int runs = 3;
  bool peers = true;
};

void print_peer(double distance, const Cost& cost, const Cost& ours) {
  std::printf(" %.5f | %.1f | %.1f | %.1f |", distance, cost.ms, cost.mb, cost.ms / ours.ms);
}

void measure_direction(const std::string& name, const TriMesh& from, const TriMesh& to, const Settings& settings) {
  HausdorffOptions options;
  options.tolerance = kTolerance;
  OneSidedHausdorff found;
  const Cost ours = measure(settings.runs, [&] { found = one_sided_hausdorff(from, to, options); });
  std::printf("| %s | %zu | %zu | %.6f - %.6f | %.1f | %.1f |", name.c_str(), from.faces.size(), to.faces.size(),
              found.lower, found.upper, ours.ms, ours.mb);
  if (settings.peers) {
    const bench::CgalMesh cgal_from(from), cgal_to(to);
    double distance = 0;
    const Cost cgal =
        measure(settings.runs, [&] { distance = cgal_from.bounded_error_hausdorff(cgal_to, kTolerance); });
    print_peer(distance, cgal, ours);
    if (bench::have_vtk()) {
      const Cost vtk = measure(settings.runs, [&] { distance = bench::vtk_vertex_distance(from, to); });
      print_peer(distance, vtk, ours);
    }
  }
  std::printf("\n");
  std::fflush(stdout);
}

void print_header(const Settings& settings) {
  const bool vtk = settings.peers && bench::have_vtk();
  std::printf("| from -> to | faces | faces | interval, mm | ms | MB |%s%s\n",
              settings.peers ? " CGAL, mm | ms | MB | times ours |" : "",
              vtk ? " VTK at vertices, mm | ms | MB | times ours |" : "");
  std::printf("|---|---|---|---|---|---|%s%s\n", settings.peers ? "---|---|---|---|" : "",
              vtk ? "---|---|---|---|" : "");
}

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--ours") == 0) settings.peers = false;
    if (std::strcmp(argv[i], "--runs") == 0 && i + 1 < argc) settings.runs = std::max(1, std::atoi(argv[++i]));
  }
  return settings;
}

}  // namespace

int main(int argc, char** argv) {
  const Settings settings = parse(argc, argv);
  const std::vector<Pair> pairs = load_pairs(VMESH_SHARED_DATA);
  print_header(settings);
  for (const Pair& pair : pairs) {
    measure_direction(pair.name + " -> " + pair.other_name, pair.fine, pair.coarse, settings);
    measure_direction(pair.other_name + " -> " + pair.name, pair.coarse, pair.fine, settings);
  }
}

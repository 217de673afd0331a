// What the paper's section on related work names, beside vmesh: plain cylinders, truncated cones, convolution surfaces
// of the segments and MPU implicits of the mask's boundary (related_work.h), measured as `vmesh table2` does. Prints
// rows for its table. Implicit surfaces are contoured at the step that they need for their own error: the largest, of
// the thinnest radius and ever 1.4 times less, of which half changes the mean distance by less than a tenth.
//
// Usage: bench_related [--surfaces FOLDER] [--voxel MM] [FOLDER of `vmesh table2 --surfaces` or CENTERLINE]...
// With such a folder, against its reference.ply; else against marching cubes of the centerline's volume, as table2
// makes them. --voxel: of the mask and of that reference (.665). Without arguments the synthetic portal vein of 1,560
// nodes. --surfaces: a folder for the surfaces.
#include "related_work.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/quality/closest_point.h"
#include "vmesh/quality/hausdorff.h"
#include "vmesh/quality/sampled_distance.h"
#include "vmesh/reference/cones.h"
#include "vmesh/reference/reference_surface.h"
#include "vmesh/surface/generate.h"
#include "vmesh/synth/synthetic_tree.h"

namespace {

using namespace vmesh;
using namespace vmesh::bench;

constexpr double kEnough = 0.1;  // change of the mean distance, relative
constexpr int kMostSteps = 6;
constexpr std::size_t kSamples = 100'000;
constexpr int kSides = 18;
constexpr double kTolerance = 1e-3;  // of Hausdorff distances, mm

struct Setting {
  std::filesystem::path surfaces;
  double voxel = 0.665;
};

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// A surface, and how far it is from the reference.
struct Made {
  TriMesh mesh;
  double seconds = 0;
  double step = 0;  // of its contour, mm; 0: none
  double mean = 0;  // of the distances, the larger way
};

class Table {
 public:
  Table(const std::string& name, const Centerline& centerline, TriMesh reference, const Setting& setting)
      : name_(name), centerline_(centerline), reference_(std::move(reference)), index_(reference_), setting_(setting) {
    std::printf("\n%s, %zu segments; voxels of %g mm\n\n", name.c_str(), centerline.segments().size(), setting.voxel);
    std::printf(
        "| surface | step, mm | vertices | faces | skewness mean / max | Hausdorff to the reference, mm | from it | "
        "mean, mm | sound | crossing pairs | CPU, s |\n|--|--:|--:|--:|--:|--:|--:|--:|--|--:|--:|\n");
    print("marching cubes, the reference", {reference_, 0, setting.voxel, 0}, false);
  }

  void add(const std::string& what, const std::function<TriMesh()>& make) {
    print(what, made(0, [&](double) { return make(); }), true);
  }

  void add_contoured(const std::string& what, const std::function<TriMesh(double)>& make) {
    Made now = made(thinnest(), make);
    for (int i = 0; i < kMostSteps; ++i) {
      const Made finer = made(now.step / 2, make);
      if (std::abs(finer.mean - now.mean) <= kEnough * finer.mean) break;
      now = made(now.step / std::numbers::sqrt2, make);
    }
    print(what, now, true);
  }

 private:
  double thinnest() const {
    double radius = centerline_.nodes().front().radius;
    for (const CenterlineNode& node : centerline_.nodes()) radius = std::min(radius, node.radius);
    return radius;
  }

  Made made(double step, const std::function<TriMesh(double)>& make) const {
    const double start = cpu_seconds();
    Made result{make(step), 0, step, 0};
    result.seconds = cpu_seconds() - start;
    result.mean = std::max(sample_distance(result.mesh, index_, kSamples).distance.mean,
                           sample_distance(reference_, ClosestPointIndex(result.mesh), kSamples).distance.mean);
    return result;
  }

  void print(const std::string& what, const Made& made, bool with_distance) const {
    const Topology topology = measure_topology(made.mesh);
    const std::size_t crossings = self_intersections(made.mesh).size();
    const bool sound = topology.closed && topology.manifold && topology.outward && crossings == 0;
    const SkewnessSummary skewness = summarize_skewness(made.mesh);
    std::printf("| %s | ", what.c_str());
    if (made.step > 0) std::printf("%.2f", made.step);
    std::printf(" | %zu | %zu | %.3f / %.3f | ", made.mesh.vertices.size(), made.mesh.faces.size(), skewness.mean,
                skewness.max);
    if (with_distance) {
      const Hausdorff distance = hausdorff(made.mesh, reference_, {kTolerance, {}});
      std::printf("%.2f | %.2f | %.3f", distance.forward.upper, distance.backward.upper, made.mean);
    } else {
      std::printf(" | | ");
    }
    std::printf(" | %s | %zu | ", sound ? "yes" : "no", crossings);
    if (made.seconds > 0) std::printf("%.2f", made.seconds);
    std::printf(" |\n");
    std::fflush(stdout);
    if (setting_.surfaces.empty()) return;
    std::filesystem::create_directories(setting_.surfaces);
    std::string file = name_ + "-" + what + ".ply";
    for (char& c : file) {
      if (c == ' ' || c == ',' || c == '/') c = '-';
    }
    write_surface(setting_.surfaces / file, made.mesh);
  }

  std::string name_;
  const Centerline& centerline_;
  TriMesh reference_;
  ClosestPointIndex index_;
  const Setting& setting_;
};

void compare(const std::string& name, const Centerline& centerline, TriMesh reference, const Setting& setting) {
  Table table(name, centerline, std::move(reference), setting);
  table.add("plain cylinders", [&] { return plain_cylinders(centerline, kSides); });
  table.add("truncated cones", [&] { return truncated_cones(centerline, kSides).mesh; });
  for (const double factor : {1.0, 5.0}) {
    const double width = factor * std::numbers::ln2;
    table.add_contoured("convolution surface, width " + std::string(factor == 1 ? "ln 2" : "5 ln 2"),
                        [&](double step) { return convolution_surface(centerline, width, step); });
  }
  for (const double share : {0.5, 1.0}) {
    table.add_contoured("MPU implicits, fits to " + std::string(share == 1 ? "a voxel" : "half a voxel"),
                        [&](double step) {
                          return mpu_surface(centerline, {setting.voxel, share * setting.voxel, step});
                        });
  }
  for (const int around : {6, 12}) {
    GenerateOptions options;
    options.around = around;
    options.threads = 1;
    table.add("vmesh, " + std::to_string(around) + " around",
              [&] { return generate_surface(centerline, options).mesh; });
  }
}

TriMesh sampled_reference(const Centerline& centerline, double voxel) {
  ReferenceOptions options;
  options.all_components = true;
  return reference_surface(centerline, voxel, options).mesh;
}

void compare_with(const std::filesystem::path& input, const Setting& setting) {
  if (std::filesystem::is_directory(input)) {
    const Centerline centerline = load_centerline(input / "centerline.json").cleaned.centerline;
    compare(input.filename().string(), centerline, read_surface(input / "reference.ply").mesh, setting);
    return;
  }
  const Centerline centerline = load_centerline(input).cleaned.centerline;
  compare(input.stem().string(), centerline, sampled_reference(centerline, setting.voxel), setting);
}

}  // namespace

int main(int argc, char** argv) {
  Setting setting;
  std::vector<std::filesystem::path> inputs;
  for (int i = 1; i < argc; ++i) {
    if (i + 1 < argc && std::strcmp(argv[i], "--surfaces") == 0) {
      setting.surfaces = argv[++i];
    } else if (i + 1 < argc && std::strcmp(argv[i], "--voxel") == 0) {
      setting.voxel = std::atof(argv[++i]);
    } else {
      inputs.emplace_back(argv[i]);
    }
  }
  if (!(setting.voxel > 0)) {
    std::fprintf(stderr, "bench_related: --voxel needs a number above 0\n");
    return 2;
  }
  if (inputs.empty()) {
    const Centerline centerline = synthetic_tree();
    compare("tree1560", centerline, sampled_reference(centerline, setting.voxel), setting);
  }
  for (const std::filesystem::path& input : inputs) compare_with(input, setting);
}

// What the paper's section on related work names, beside vmesh: plain cylinders, truncated cones, convolution surfaces
// of the segments and MPU implicits of the mask's boundary (related_work.h), measured as `vmesh table2` does. Prints
// rows for its table. Implicit surfaces are contoured at the step that they need for their own error: the largest, in
// steps of a factor of sqrt(2), with which half of it changes the Hausdorff distance by less than a tenth.
//
// Usage: bench_related [--surfaces FOLDER] [--voxel MM] [FOLDER of `vmesh table2 --surfaces` or CENTERLINE]...
// With such a folder, against its reference.ply; else against marching cubes of the centerline's volume, as table2
// makes them. --voxel: of the mask and of that reference (.665). Without arguments the synthetic portal vein of 1,560
// nodes. --surfaces: a folder for the surfaces.
#include "related_work.h"

#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>

#include "vmesh/evaluation/vessel_distance.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/quality/hausdorff.h"
#include "vmesh/reference/cones.h"
#include "vmesh/reference/reference_surface.h"
#include "vmesh/surface/generate.h"
#include "vmesh/synth/synthetic_tree.h"

namespace {

using namespace vmesh;
using namespace vmesh::bench;

constexpr double kEnough = 0.1;    // change of the Hausdorff distance, relative
constexpr int kMostHalvings = 10;  // of the square of the step
constexpr int kSides = 18;

struct Setting {
  std::filesystem::path surfaces;
  double voxel = 0.665;
};

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Made {
  TriMesh mesh;
  double seconds = 0;
  double step = 0;  // 0: none
};

class Table {
 public:
  Table(const std::string& name, const Centerline& centerline, TriMesh reference, const Setting& setting)
      : name_(name), centerline_(centerline), reference_(std::move(reference)), setting_(setting) {
    std::printf("\n%s, %zu segments; voxels of %g mm\n\n", name.c_str(), centerline.segments().size(), setting.voxel);
    std::printf(
        "| surface | step, mm | vertices | faces | skewness mean / max | Hausdorff to the reference, mm | from it | "
        "sound | crossing pairs | CPU, s |\n|--|--:|--:|--:|--:|--:|--:|--|--:|--:|\n");
    print("marching cubes, the reference", {reference_, 0, setting.voxel}, nullptr);
  }

  void add(const std::string& what, const std::function<TriMesh()>& make, double step = 0) {
    const double start = cpu_seconds();
    Made made{make(), 0, step};
    made.seconds = cpu_seconds() - start;
    const Hausdorff distance = hausdorff(made.mesh, reference_, {1e-3, {}});
    print(what, made, &distance);
  }

  // From a step of the thinnest radius on.
  void add_contoured(const std::string& what, const std::function<TriMesh(double)>& make) {
    double step = thinnest();
    double start = cpu_seconds();
    Made now{make(step), cpu_seconds() - start, step};
    Hausdorff distance = hausdorff(now.mesh, reference_, {1e-3, {}});
    for (int i = 0; i < kMostHalvings; ++i) {
      start = cpu_seconds();
      const TriMesh finer = make(step / 2);
      const double seconds = cpu_seconds() - start;
      const Hausdorff then = hausdorff(finer, reference_, {1e-3, {}});
      if (std::abs(then.upper() - distance.upper()) <= kEnough * then.upper()) break;
      step /= std::numbers::sqrt2;
      if (i % 2 == 1) {
        // Two steps down is the half that has been made.
      }
      start = cpu_seconds();
      now = {make(step), 0, step};
      now.seconds = cpu_seconds() - start;
      distance = hausdorff(now.mesh, reference_, {1e-3, {}});
      (void)seconds;
    }
    print(what, now, &distance);
  }

 private:
  double thinnest() const {
    double radius = centerline_.nodes().front().radius;
    for (const CenterlineNode& node : centerline_.nodes()) radius = std::min(radius, node.radius);
    return radius;
  }

  void print(const std::string& what, const Made& made, const Hausdorff* distance) {
    const Topology topology = measure_topology(made.mesh);
    const std::size_t crossings = self_intersections(made.mesh).size();
    const bool sound = topology.closed && topology.manifold && topology.outward && crossings == 0;
    const SkewnessSummary skewness = summarize_skewness(made.mesh);
    std::printf("| %s | ", what.c_str());
    if (made.step > 0) std::printf("%.2f", made.step);
    std::printf(" | %zu | %zu | %.3f / %.3f | ", made.mesh.vertices.size(), made.mesh.faces.size(), skewness.mean,
                skewness.max);
    if (distance != nullptr)
      std::printf("%.2f | %.2f", distance->forward.upper, distance->backward.upper);
    else
      std::printf(" | ");
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

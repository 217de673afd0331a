// Gain and cost of fitting, with even and with long triangles, beside edge collapse of the reference to as many
// vertices (Garland and Heckbert by CGAL and by VTK; Lindstrom and Turk by CGAL): a table in Markdown. Distances are
// the larger of both directions, mm; time is user CPU on one thread, including the report's own measurements. Usage:
//   bench_fit            the table; cases are those of ../shared/data named below
//   bench_fit CHART.svg  mean distance against CPU time and vertices, from coarse to fine, for the second case
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>

#include <sys/resource.h>

#include "vmesh/centerline/round_ends.h"
#include "vmesh/fit/fit_surface.h"
#include "vmesh/image/image_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/reference/reference_surface.h"
#include "vmesh/skeleton/extract_centerline.h"
#include "vmesh/surface/metric_skewness.h"
#include "vmesh/tuning/plot.h"
#include "vmesh/volume/contacts.h"

#include "peers.h"

namespace {

using namespace vmesh;

struct Case {
  const char* name;
  std::string file;
  std::optional<double> label;  // of an image, contoured at 1 mm, smoothed by 1 mm
  int around = vertices_around(Preset::low);
};

const Case kCases[] = {
    {"portal vein 002", "liver_segmentations/hepaticvessel_002_vsnet.nii.gz", 2},
    {"portal vein 008", "liver_segmentations/hepaticvessel_008_vsnet.nii.gz", 2},
    {"portal vein 008, high", "liver_segmentations/hepaticvessel_008_vsnet.nii.gz", 2, vertices_around(Preset::high)},
    {"hepatic veins 002", "liver_segmentations/hepaticvessel_002_vsnet.nii.gz", 1},
    {"hepatic veins 008", "liver_segmentations/hepaticvessel_008_vsnet.nii.gz", 1},
    {"pulmonary arteries SU201", "pairs_centerline_surface/generate-1d-mesh_example_SU201_2005_RPA1_exterior.vtp", {}},
    {"aorta", "pairs_centerline_surface/aorta-surface.stl", {}},
};

double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

TriMesh reference_of(const Case& c) {
  const std::string path = std::string(VMESH_SHARED_DATA) + "/" + c.file;
  if (!c.label) return read_surface(path).mesh;
  ReferenceOptions options;
  options.labels = {*c.label};
  options.spacing = options.smooth = 1;
  return reference_surface(read_image(path), options).mesh;
}

struct Distances {
  double hausdorff, mean, p95;
};

Distances distances(const TriMesh& surface, const TriMesh& reference) {
  const ClosestPointIndex to_reference(reference), to_surface(surface);
  const Distribution a = sample_distance(surface, to_reference, 100'000).distance;
  const Distribution b = sample_distance(reference, to_surface, 100'000).distance;
  return {hausdorff(surface, reference, {1e-3, {}}).upper(), std::max(a.mean, b.mean), std::max(a.p95, b.p95)};
}

// Skewness is that in the metric of the elongation, if there is one.
void print(const char* name, const char* method, const TriMesh& mesh, const Distances& d, double seconds,
           const std::vector<Vec3>& elongation = {}) {
  const SkewnessSummary skewness = summarize_skewness(metric_skewness(mesh, elongation));
  const bool closed = measure_topology(mesh).closed;
  std::printf("| %s | %s | %zu | %.2f | %.3f | %.3f | %.3f / %.3f | %s, %zu | ", name, method, mesh.vertices.size(),
              d.hausdorff, d.mean, d.p95, skewness.mean, skewness.max, closed ? "yes" : "no",
              self_intersections(mesh).size());
  if (seconds > 0) std::printf("%.2f", seconds);
  std::printf(" |\n");
}

void print_collapsed(const char* method, const TriMesh& collapsed, const TriMesh& reference) {
  print("", method, collapsed, distances(collapsed, reference), 0);
}

// Returns the number of vertices.
std::size_t print_fitted(const char* method, const GenerateResult& grown, const Centerline& centerline,
                         const TriMesh& reference, FitOptions options) {
  GenerateResult result = grown;
  options.threads = 1;
  const double begin = user_seconds();
  fit_surface(result, centerline, reference, options);
  const double seconds = user_seconds() - begin;
  print("", method, result.mesh, distances(result.mesh, reference), seconds, result.elongation);
  return result.mesh.vertices.size();
}

Centerline centerline_of(const TriMesh& reference, const Case& c) {
  ExtractOptions extraction;
  extraction.tree = c.label.has_value();
  const ExtractedCenterline extracted = extract_centerline(reference, extraction);
  return separate_contacts(with_round_ends(extracted.centerline, extracted.end_sections)).centerline;
}

FitOptions elongated_to(std::size_t vertices) {
  FitOptions options;
  options.elongation = kMostElongation;
  options.max_vertices = vertices;
  return options;
}

void measure(const Case& c) {
  const TriMesh reference = reference_of(c);
  const Centerline centerline = centerline_of(reference, c);
  GenerateOptions options;
  options.around = c.around;
  const GenerateResult grown = generate_surface(centerline, options);
  print(c.name, "round cones", grown.mesh, distances(grown.mesh, reference), 0);
  const std::size_t vertices = print_fitted("fitted", grown, centerline, reference, {});
  print_fitted("fitted, long triangles", grown, centerline, reference, elongated_to(vertices));
  const double share = static_cast<double>(vertices) / static_cast<double>(reference.vertices.size());
  const bench::CgalMesh peer(reference);
  print_collapsed("quadric decimation, CGAL", peer.quadric_decimated(share), reference);
  if (bench::have_vtk())
    print_collapsed("quadric decimation, VTK", bench::vtk_quadric_decimated(reference, share), reference);
  print_collapsed("edge collapse, Lindstrom and Turk", peer.decimated(share), reference);
}

struct Point {
  double seconds;
  std::size_t vertices;
  double mean;
};

struct Curve {
  const char* name;
  std::vector<Point> points{};
};

template <class Make>
Point timed(const TriMesh& reference, Make&& make) {
  const double begin = user_seconds();
  const TriMesh mesh = make();
  const double seconds = user_seconds() - begin;
  return {seconds, mesh.vertices.size(), distances(mesh, reference).mean};
}

// Time from the centerline, or the reference, on.
std::vector<Curve> sweep(const Case& c) {
  const TriMesh reference = reference_of(c);
  const Centerline centerline = centerline_of(reference, c);
  const bench::CgalMesh peer(reference);
  Curve cones{"round cones"}, even{"fitted"}, elongated{"fitted, elongation 16"}, quadric{"quadric decimation"},
      collapsed{"edge collapse, Lindstrom and Turk"};
  for (const int around : {5, 6, 8, 12, 16}) {
    GenerateOptions options;
    options.around = around;
    options.threads = 1;
    const auto fitted = [&](FitOptions fit) {
      return timed(reference, [&] {
        GenerateResult result = generate_surface(centerline, options);
        fit.threads = 1;
        fit_surface(result, centerline, reference, fit);
        return result.mesh;
      });
    };
    cones.points.push_back(timed(reference, [&] { return generate_surface(centerline, options).mesh; }));
    even.points.push_back(fitted({}));
    const std::size_t vertices = even.points.back().vertices;
    elongated.points.push_back(fitted(elongated_to(vertices)));
    const double share = static_cast<double>(vertices) / static_cast<double>(reference.vertices.size());
    quadric.points.push_back(timed(reference, [&] { return peer.quadric_decimated(share); }));
    collapsed.points.push_back(timed(reference, [&] { return peer.decimated(share); }));
  }
  return {cones, even, elongated, quadric, collapsed};
}

template <class Cost>
LogPlot plot_of(const std::vector<Curve>& curves, const char* title, const char* label, Cost&& cost) {
  LogPlot plot{title, label, "mean distance, mm", {}};
  for (const Curve& curve : curves) {
    plot.curves.push_back({curve.name, {}});
    for (const Point& point : curve.points) plot.curves.back().points.emplace_back(cost(point), point.mean);
  }
  return plot;
}

void draw(const std::vector<Curve>& curves, const char* file) {
  std::ofstream(file) << svg_of(
      {plot_of(curves, "Distance against time", "CPU time, s", [](const Point& p) { return p.seconds; }),
       plot_of(curves, "Distance against vertices", "vertices",
               [](const Point& p) { return static_cast<double>(p.vertices); })});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) {
    draw(sweep(kCases[1]), argv[1]);
    return 0;
  }
  std::printf(
      "| vessels | surface | vertices | Hausdorff | mean | 95 %% | skewness mean / max | closed, crossing pairs | "
      "CPU, s |\n|---|---|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const Case& c : kCases) {
    try {
      measure(c);
    } catch (const std::exception& error) {
      std::printf("| %s | %s | | | | | | | |\n", c.name, error.what());
    }
    std::fflush(stdout);
  }
}

// The results of `vmesh tradeoff`, with additional curves: CGAL's Mesh_3 on the same field, convolution surfaces, MPU
// implicits and plain cylinders (related_work.h). Writes PREFIX.md and PREFIX.svg. Usage: bench_tradeoff PREFIX
// [CENTERLINE]; without a centerline the synthetic portal vein of 1,560 vertices.
#include "vmesh/tuning/tradeoff.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <numbers>

#include "vmesh/io/centerline_io.h"
#include "vmesh/synth/synthetic_tree.h"

#include "mesh_3.h"
#include "related_work.h"

namespace {

using namespace vmesh;
using bench::mesh_3;

constexpr double kWidth = 5 * std::numbers::ln2;  // of convolution surfaces: nearer than ln 2

template <class Make>
void add_point(std::vector<TradeoffPoint>& points, const Centerline& centerline, const std::string& curve,
               const std::string& setting, const Make& make) {
  TradeoffPoint point;
  point.curve = curve;
  point.setting = setting;
  const auto begin = std::chrono::steady_clock::now();
  const TriMesh mesh = make();
  point.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::fprintf(stderr, "\n%s, %s: %.1f s, %zu vertices", curve.c_str(), setting.c_str(), point.seconds,
               mesh.vertices.size());
  measure_tradeoff_point(point, mesh, centerline);
  points.push_back(point);
}

void add_mesh_3(std::vector<TradeoffPoint>& points, const Centerline& centerline) {
  for (const int around : {4, 6, 8, 12, 24, 48})
    add_point(points, centerline, "CGAL Mesh_3", std::to_string(around) + " around",
              [&] { return mesh_3(centerline, around); });
}

// Steps and voxels relative to the thinnest radius.
void add_related_work(std::vector<TradeoffPoint>& points, const Centerline& centerline) {
  double thinnest = centerline.nodes().front().radius;
  for (const CenterlineNode& node : centerline.nodes()) thinnest = std::min(thinnest, node.radius);
  for (const double share : {2.0, 1.41, 1.0, 0.71, 0.5}) {
    const double step = share * thinnest;
    const std::string setting = "step " + std::to_string(step) + " mm";
    add_point(points, centerline, "convolution surface", setting,
              [&] { return bench::convolution_surface(centerline, kWidth, step); });
    add_point(points, centerline, "MPU implicits", setting, [&] {
      return bench::mpu_surface(centerline, {0.5 * step, 0.25 * step, step});
    });
  }
  for (const int sides : {6, 12, 18})
    add_point(points, centerline, "plain cylinders", std::to_string(sides) + " around",
              [&] { return bench::plain_cylinders(centerline, sides); });
}

void write_markdown(const std::string& file, const std::vector<TradeoffPoint>& points) {
  std::FILE* out = std::fopen(file.c_str(), "w");
  if (out == nullptr) throw std::runtime_error("cannot write " + file);
  std::fprintf(
      out,
      "| curve | setting | seconds | vertices | skewness mean | max | error mean, mm | rms | max | mean, radii "
      "| rms | max | sound |\n|--|--|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--|\n");
  for (const TradeoffPoint& p : points)
    std::fprintf(out, "| %s | %s | %.3f | %zu | %.3f | %.3f | %.4f | %.4f | %.3f | %.4f | %.4f | %.3f | %s |\n",
                 p.curve.c_str(), p.setting.c_str(), p.seconds, p.vertices, p.skewness_mean, p.skewness_max,
                 p.error_mean_mm, p.error_rms_mm, p.error_max_mm, p.error_mean_relative, p.error_rms_relative,
                 p.error_max_relative, p.sound ? "yes" : "no");
  std::fprintf(out,
               "\n| theirs | vertices | ours | vertices at the same maximum error, ratio | mean error with as many "
               "vertices, ratio | mean skewness, ratio |\n|--|--:|--|--:|--:|--:|\n");
  for (const char* theirs : {"marching cubes", "marching cubes, decimated", "marching cubes, quadric decimation",
                             "CGAL Mesh_3", "convolution surface", "MPU implicits", "plain cylinders"}) {
    for (const char* ours : {"around, blend 0", "max-error", "max-error, elongation 4", "max-error, elongation 16",
                             "max-error in mm, elongation 16", "vertices, elongation 16"}) {
      for (const CurveComparison& c : compare_curves(points, ours, theirs))
        std::fprintf(out, "| %s | %zu | %s | %.2f | %.2f | %.2f |\n", theirs, c.theirs.vertices, ours,
                     c.our_vertices / static_cast<double>(c.theirs.vertices),
                     c.our_error_mean_mm / c.theirs.error_mean_mm, c.our_skewness_mean / c.theirs.skewness_mean);
    }
  }
  std::fclose(out);
}

bool tell_percent(std::string_view, double fraction) {
  static int told = -1;
  const int percent = static_cast<int>(100 * fraction);
  if (percent > told) std::fprintf(stderr, "\rvmesh, marching cubes and cones: %d %%", told = percent);
  return true;
}

// After each group of curves: a bench of hours that is stopped leaves what it has.
void write_results(const std::string& prefix, std::vector<TradeoffPoint> points) {
  mark_best(points);
  write_markdown(prefix + ".md", points);
  std::ofstream(prefix + ".svg") << plot_tradeoff(points);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') {
    std::fprintf(stderr, "usage: bench_tradeoff PREFIX [CENTERLINE]\n");
    return 2;
  }
  const std::string prefix = argv[1];
  const Centerline centerline = argc > 2 ? load_centerline(argv[2]).cleaned.centerline : synthetic_tree();
  TradeoffOptions options;
  options.generate.threads = 1;
  options.fine = true;
  std::vector<TradeoffPoint> points = sweep_tradeoff(centerline, options, tell_percent);
  write_results(prefix, points);
  add_mesh_3(points, centerline);
  write_results(prefix, points);
  add_related_work(points, centerline);
  write_results(prefix, points);
}

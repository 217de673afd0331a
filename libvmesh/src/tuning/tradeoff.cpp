#include "vmesh/tuning/tradeoff.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <span>

#include "vmesh/core/ascending.h"
#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/evaluation/vessel_distance.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/reference/cones.h"
#include "vmesh/reference/reference_surface.h"
#include "vmesh/tuning/budget.h"

#include "tuning/decimation.h"

namespace vmesh {
namespace {

constexpr int kArounds[] = {3, 4, 5, 6, 8, 10, 12, 16, 20};
constexpr int kFineArounds[] = {24, 32, 48, 64, 96};
constexpr double kBetas[] = {0, 0.15, 0.3, 0.6, 1};
constexpr double kLimits[] = {0.4, 0.3, 0.2, 0.15, 0.1, 0.07, 0.05};  // of --max-error, local radii
constexpr double kFineLimits[] = {0.03, 0.02, 0.01, 0.005, 0.0025};   // only of even triangles
constexpr int kLimitAround = 5;                                       // so that the limit decides
constexpr double kElongations[] = {1, 4, 16};                         // with each of these limits
constexpr double kBlends[] = {0, 0.1, 0.25, 0.5, 1};
constexpr int kEfforts[] = {0, 10, 20, 30, 60};               // sweeps
constexpr double kVoxels[] = {1.4, 1, 0.7, 0.5, 0.35, 0.25};  // in mean radii
constexpr double kFineVoxels[] = {0.18, 0.125};
constexpr double kMostVoxels = 1.5e8;  // beyond, a voxel size is left out
constexpr std::size_t kMostRuns = 5;
constexpr double kLongEnough = 0.5;                // seconds
constexpr double kLimitWork = 7, kCountWork = 20;  // how much longer cases with a limit, or a number of vertices, take
constexpr int kSides[] = {6, 12, 18};              // of truncated cones
constexpr std::array<std::pair<const char*, Decimation>, 2> kDecimations = {
    {{"marching cubes, decimated", Decimation::volume}, {"marching cubes, quadric decimation", Decimation::quadrics}}};

std::string text_of(double value) { return formatted("%g", value); }

// The mean radius along the centerline.
double mean_radius(const Centerline& centerline) {
  double sum = 0, length = 0;
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    sum += centerline.length(s) * centerline.radius_at(s, 0.5);
    length += centerline.length(s);
  }
  return length > 0 ? sum / length : centerline.node(0).radius;
}

// Median time of up to five runs, as long as they are short: the first one may be slow.
template <class Work>
double median_seconds(Work&& work) {
  std::vector<double> seconds;
  for (double total = 0; seconds.empty() || (seconds.size() < kMostRuns && total < kLongEnough);
       total += seconds.back()) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return median(std::move(seconds));
}

double voxels_of_box(const Centerline& centerline, double voxel) {
  Eigen::AlignedBox3d box;
  for (const auto& node : centerline.nodes()) {
    box.extend(node.position - Vec3::Constant(node.radius));
    box.extend(node.position + Vec3::Constant(node.radius));
  }
  return (box.sizes() / voxel).prod();
}

class Sweep {
 public:
  Sweep(const Centerline& centerline, const TradeoffOptions& options, const Progress& progress)
      : centerline_(centerline), options_(options), progress_(progress), work_(expected_work()) {}

  std::vector<TradeoffPoint> run() {
    const GenerateOptions& given = options_.generate;
    if (options_.resolution) {
      for (const int around : arounds()) vary("around", std::to_string(around), [&](auto& o) { o.around = around; });
      for (const int around : arounds())
        vary("around, blend 0", std::to_string(around), [&](auto& o) { o.around = around, o.blend = 0; });
    }
    if (options_.max_error) {
      for (const double elongation : kElongations) {
        const std::string curve = elongation > 1 ? "max-error, elongation " + text_of(elongation) : "max-error";
        for (const double limit : limits(elongation))
          vary(
              curve, text_of(100 * limit) + " %",
              [&](GenerateOptions& o) {
                o.around = std::min(given.around, kLimitAround);
                o.max_error.relative = limit;
                o.elongation = elongation;
                o.blend = 0;
              },
              kLimitWork);
      }
      // Like marching cubes, whose voxels have one size for thick and thin vessels.
      const double most = kElongations[std::size(kElongations) - 1], radius = mean_radius(centerline_);
      for (const double limit : kLimits)
        vary(
            "max-error in mm, elongation " + text_of(most), text_of(limit * radius) + " mm",
            [&](GenerateOptions& o) {
              o.around = std::min(given.around, kLimitAround);
              o.max_error.mm = limit * radius;
              o.elongation = most;
              o.blend = 0;
            },
            kLimitWork);
    }
    if (options_.blend) {
      for (const double blend : kBlends) vary("blend", text_of(blend), [&](auto& o) { o.blend = blend; });
    }
    if (options_.beta) {
      for (const double beta : kBetas)
        vary("beta, single seed", text_of(beta), [&](GenerateOptions& o) {
          o.beta = beta;
          o.growth = GrowthMethod::paper;
        });
    }
    if (options_.effort) {
      for (const int sweeps : kEfforts) vary("sweeps", std::to_string(sweeps), [&](auto& o) { o.sweeps = sweeps; });
    }
    if (options_.marching_cubes) sweep_marching_cubes();
    if (options_.max_error) sweep_vertices();
    if (options_.cones) sweep_cones();
    report_progress(progress_, kStage, 1);
    mark_best(points_);
    return std::move(points_);
  }

 private:
  static constexpr const char* kStage = "sweep";

  // Of a curve: with `fine`, the settings at its accurate end as well.
  template <class Value>
  std::vector<Value> with_fine(std::span<const Value> settings, std::span<const Value> fine) const {
    std::vector<Value> all(settings.begin(), settings.end());
    if (options_.fine) all.insert(all.end(), fine.begin(), fine.end());
    return all;
  }
  std::vector<int> arounds() const { return with_fine<int>(kArounds, kFineArounds); }
  std::vector<double> limits(double elongation) const {
    return elongation > 1 ? with_fine<double>(kLimits, {}) : with_fine<double>(kLimits, kFineLimits);
  }
  std::vector<double> voxels() const { return with_fine<double>(kVoxels, kFineVoxels); }

  // In cases of plain settings.
  double expected_work() const {
    const TradeoffOptions& o = options_;
    const auto size = [](const auto& list) { return static_cast<double>(std::size(list)); };
    const double counts = o.resolution ? size(kArounds) + 1 : 0;
    double work = 0;
    if (o.resolution) work += 2 * size(arounds());
    if (o.max_error) {
      work += kLimitWork * size(kLimits) + kCountWork * counts;  // in mm, and for numbers of vertices
      for (const double elongation : kElongations) work += kLimitWork * size(limits(elongation));
    }
    if (o.blend) work += size(kBlends);
    if (o.beta) work += size(kBetas);
    if (o.effort) work += size(kEfforts);
    if (o.marching_cubes) work += size(voxels()) + size(kDecimations) * counts;
    if (o.cones) work += size(kSides);
    return work;
  }

  // One progress for all cases: that of a single one only asks whether to go on.
  void tell() const { report_progress(progress_, kStage, work_ > 0 ? std::min(1.0, done_ / work_) : 0); }

  Progress alive() const {
    return [this](std::string_view, double) {
      tell();
      return true;
    };
  }

  template <class Make>
  std::optional<TriMesh> add(const std::string& curve, const std::string& setting, Make&& make, double work = 1) {
    tell();
    std::optional<TriMesh> mesh = add_point(curve, setting, make);
    done_ += work;
    return mesh;
  }

  // Makes a surface and adds its point; a refused case has no point.
  template <class Make>
  std::optional<TriMesh> add_point(const std::string& curve, const std::string& setting, Make&& make) {
    TradeoffPoint point;
    point.curve = curve;
    point.setting = setting;
    TriMesh mesh;
    try {
      point.seconds = median_seconds([&] { mesh = make(); });
    } catch (const Unsupported&) {
      return std::nullopt;
    } catch (const InvalidInput&) {
      return std::nullopt;
    }
    measure_tradeoff_point(point, mesh, centerline_, options_.samples);
    points_.push_back(point);
    return mesh;
  }

  template <class Change>
  void vary(const std::string& curve, const std::string& setting, Change&& change, double work = 1) {
    GenerateOptions options = options_.generate;
    change(options);
    add(
        curve, setting, [&] { return generate_surface(centerline_, options, alive()).mesh; }, work);
  }

  // As many vertices as the even surfaces have but at the accurate end, and half as many as the coarsest.
  std::vector<std::size_t> counts() const {
    std::vector<std::size_t> counts;
    for (const TradeoffPoint& point : points_) {
      if (point.curve != "around" || counts.size() > std::size(kArounds)) continue;
      if (counts.empty()) counts.push_back(point.vertices / 2);
      counts.push_back(point.vertices);
    }
    return counts;
  }

  // With the longest triangles.
  void sweep_vertices() {
    for (const std::size_t count : counts()) {
      GenerateOptions options = options_.generate;
      options.elongation = kElongations[std::size(kElongations) - 1];
      options.blend = 0;
      Budget budget;
      budget.vertices = count;
      add(
          "vertices, elongation " + text_of(options.elongation), std::to_string(count),
          [&] { return generate_within(budget, centerline_, options, alive()).result.mesh; }, kCountWork);
    }
  }

  void sweep_marching_cubes() {
    const double radius = mean_radius(centerline_);
    std::optional<TriMesh> finest;
    double seconds = 0;
    for (const double share : voxels()) {
      const double voxel = share * radius;
      if (voxels_of_box(centerline_, voxel) > kMostVoxels) {
        ++done_;
        continue;
      }
      std::optional<TriMesh> mesh =
          add("marching cubes", text_of(voxel) + " mm", [&] { return reference_surface(centerline_, voxel).mesh; });
      if (!mesh) continue;
      finest = std::move(mesh);
      seconds = points_.back().seconds;
    }
    if (!finest) return;
    for (const auto& [curve, order] : kDecimations) {
      for (const std::size_t count : counts()) {
        if (count >= finest->vertices.size()) {
          ++done_;
          continue;
        }
        if (add(curve, std::to_string(count), [&, order = order] { return decimated(*finest, count, order); }))
          points_.back().seconds += seconds;
      }
    }
  }

  void sweep_cones() {
    for (const int sides : kSides)
      add("truncated cones", std::to_string(sides), [&] { return truncated_cones(centerline_, sides).mesh; });
  }

  const Centerline& centerline_;
  const TradeoffOptions& options_;
  const Progress& progress_;
  double work_;      // unless cases are left out
  double done_ = 0;  // of it, for refused cases as well
  std::vector<TradeoffPoint> points_;
};

// `y` at `x` on the curve through the points ascending in x, interpolated in logarithms. NaN beyond its ends.
double read_curve(std::vector<std::pair<double, double>> points, double x) {
  std::sort(points.begin(), points.end());
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto& [x0, y0] = points[i - 1];
    const auto& [x1, y1] = points[i];
    if (!(x >= x0 && x <= x1) || !(x0 > 0 && y0 > 0 && y1 > 0)) continue;
    const double share = x1 > x0 ? std::log(x / x0) / std::log(x1 / x0) : 0;
    return y0 * std::pow(y1 / y0, share);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

template <class Cost>
bool is_best(const std::vector<TradeoffPoint>& points, const TradeoffPoint& candidate, Cost&& cost) {
  return std::none_of(points.begin(), points.end(), [&](const TradeoffPoint& other) {
    return cost(other) <= cost(candidate) && other.error_mean_mm <= candidate.error_mean_mm &&
           (cost(other) < cost(candidate) || other.error_mean_mm < candidate.error_mean_mm);
  });
}

}  // namespace

void measure_tradeoff_point(TradeoffPoint& point, const TriMesh& mesh, const Centerline& centerline,
                            std::size_t samples) {
  point.vertices = mesh.vertices.size();
  const SkewnessSummary skewness = summarize_skewness(mesh);
  point.skewness_mean = skewness.mean;
  point.skewness_max = skewness.max;
  const VesselDistance distance =
      measure_vessel_distance(mesh, ClosestPointIndex(mesh), VesselField(centerline, 0), samples);
  const auto &from = distance.from_mesh, &to = distance.from_volume;
  point.error_mean_mm = 0.5 * (from.mm.mean + to.mm.mean);
  point.error_rms_mm = std::sqrt(0.5 * (from.mm.rms * from.mm.rms + to.mm.rms * to.mm.rms));
  point.error_max_mm = std::max(from.mm.max, to.mm.max);
  point.error_mean_relative = 0.5 * (from.relative.mean + to.relative.mean);
  point.error_rms_relative =
      std::sqrt(0.5 * (from.relative.rms * from.relative.rms + to.relative.rms * to.relative.rms));
  point.error_max_relative = std::max(from.relative.max, to.relative.max);
  const Topology topology = measure_topology(mesh);
  point.sound = topology.closed && topology.manifold && topology.outward && self_intersections(mesh).empty();
}

void mark_best(std::vector<TradeoffPoint>& points) {
  for (TradeoffPoint& point : points) {
    point.best_for_time = is_best(points, point, [](const TradeoffPoint& p) { return p.seconds; });
    point.best_for_vertices =
        is_best(points, point, [](const TradeoffPoint& p) { return static_cast<double>(p.vertices); });
  }
}

std::vector<CurveComparison> compare_curves(const std::vector<TradeoffPoint>& points, const std::string& ours,
                                            const std::string& theirs) {
  std::vector<std::pair<double, double>> mean_error, skewness, vertices;
  for (const TradeoffPoint& point : points) {
    if (point.curve != ours) continue;
    const auto count = static_cast<double>(point.vertices);
    mean_error.emplace_back(count, point.error_mean_mm);
    skewness.emplace_back(count, point.skewness_mean);
    vertices.emplace_back(point.error_max_mm, count);
  }
  std::vector<CurveComparison> comparisons;
  for (const TradeoffPoint& point : points) {
    if (point.curve != theirs) continue;
    const auto count = static_cast<double>(point.vertices);
    comparisons.push_back(
        {point, read_curve(mean_error, count), read_curve(skewness, count), read_curve(vertices, point.error_max_mm)});
  }
  return comparisons;
}

std::vector<TradeoffPoint> sweep_tradeoff(const Centerline& centerline, const TradeoffOptions& options,
                                          const Progress& progress) {
  return Sweep(centerline, options, progress).run();
}

}  // namespace vmesh

#include "vmesh/tuning/budget.h"

#include <charconv>
#include <chrono>
#include <map>
#include <optional>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {
namespace {

constexpr int kCoarsest = 3, kFinest = 200;  // vertices around that generate_surface() accepts
constexpr int kMaxTrials = 12;               // the secant needs four or five; time is noisy
constexpr double kRefused = 0.8;             // of max_vertices: if more are expected, the run may be refused
constexpr int kMostFiner = 3;                // refinement steps while the error is not proven
constexpr double kStart = 12;                // times the vertices wanted: a surface to leave vertices out of
constexpr double kNearBudget = 0.95;         // of the vertices wanted: near enough
constexpr int kMostSpacings = 4;             // distances of rings tried for that
constexpr int kErrorLadder[] = {4, 5, 6, 8, 10, 12, 16, 20, 24};

InvalidInput unknown_budget(std::string_view text) {
  return InvalidInput("budget \"" + std::string(text) +
                      "\": must be such as vertices=5000, time=50ms, time=2s, error=0.2mm or error=5%");
}

// A positive number and the unit after it.
std::pair<double, std::string_view> parse_quantity(std::string_view text, std::string_view whole) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value) || value <= 0) throw unknown_budget(whole);
  return {value, text.substr(static_cast<std::size_t>(end - text.data()))};
}

class BudgetSearch {
 public:
  BudgetSearch(const Budget& budget, const Centerline& centerline, const GenerateOptions& options,
               const Progress& progress)
      : budget_(budget), centerline_(centerline), options_(options), progress_(progress) {
    if (budget.kind == Budget::Kind::error) options_.max_error = budget.error;
  }

  BudgetedSurface run() {
    if (budget_.kind == Budget::Kind::error) {
      find_fewest_vertices();
    } else if (budget_.kind == Budget::Kind::vertices && options_.elongation > 1 && !options_.deformable) {
      leave_out_the_rest();
    } else {
      find_finest();
      if (budget_.kind == Budget::Kind::vertices) fill_up();
    }
    return result();
  }

 private:
  struct Trial {
    OperatingPoint point;
    std::size_t unproven = 0;
  };

  // The cost of a trial in terms of the budget, and the most that it may cost.
  double cost(const OperatingPoint& point) const {
    return budget_.kind == Budget::Kind::time ? point.seconds : static_cast<double>(point.vertices);
  }
  double allowed() const {
    return budget_.kind == Budget::Kind::time ? budget_.seconds : static_cast<double>(budget_.vertices);
  }

  // Costs grow about as the square of the vertices around: a secant method on that law, within the interval still open
  // and without trials that would be refused.
  void find_finest() {
    int fits = kCoarsest - 1, too_fine = kFinest + 1;
    int around = std::clamp(options_.around, kCoarsest, kFinest);
    for (int trial = 0; trial < kMaxTrials && too_fine - fits > 1; ++trial) {
      const OperatingPoint& point = attempt(around).point;
      (cost(point) <= allowed() ? fits : too_fine) = around;
      const double refused = around * std::sqrt(kRefused * options_.max_vertices / static_cast<double>(point.vertices));
      too_fine = static_cast<int>(std::clamp<double>(std::ceil(refused), fits + 1, too_fine));
      const double law = around * std::sqrt(allowed() / std::max(cost(point), 1e-9));
      around = static_cast<int>(std::clamp<double>(std::floor(law), fits + 1, std::max(too_fine - 1, fits + 1)));
    }
    if (fits > kCoarsest) attempt(fits - 1);
  }

  // Between two whole numbers of vertices around, vertices are inversely proportional to the distance of rings. Starts
  // from the nearer of the surfaces with one number and the next.
  void fill_up() {
    const OperatingPoint* start = nullptr;
    for (const auto& [setting, trial] : trials_) {
      if (start == nullptr || misses(trial.point) < misses(*start)) start = &trial.point;
    }
    const int around = start->options.around;
    double spacing = start->options.ring_spacing, vertices = static_cast<double>(start->vertices);
    for (int i = 0; i < kMostSpacings && !near_enough(); ++i) {
      const double aim = std::min(0.5 * (1 + kNearBudget) * allowed(), kRefused * options_.max_vertices);
      const double next = brief(std::clamp(spacing * vertices / aim, kLeastRingSpacing, kMostRingSpacing));
      if (next == spacing || spacing * vertices > next * allowed()) return;  // out of reach
      spacing = next;
      vertices = static_cast<double>(attempt(around, spacing).point.vertices);
    }
  }

  // To three decimals, as the command prints it.
  static double brief(double spacing) { return std::round(1000 * spacing) / 1000; }

  // By which factor, above or below, the vertices are not those wanted.
  double misses(const OperatingPoint& point) const {
    return std::abs(std::log(static_cast<double>(point.vertices) / allowed()));
  }

  bool near_enough() const {
    const std::size_t vertices = best_->surface.mesh.vertices.size();
    return vertices <= budget_.vertices && static_cast<double>(vertices) >= kNearBudget * allowed();
  }

  void leave_out_the_rest() {
    options_.least_vertices = budget_.vertices;
    const double start = std::min(kStart * allowed(), kRefused * options_.max_vertices);
    int around = std::max(kCoarsest, least_around(centerline_, options_.max_error));
    while (around < kFinest && expected_vertices(centerline_, around) < start) ++around;
    attempt(around);
  }

  // Goes up from the given resolution until the limit is proven, then to the fewest vertices.
  void find_fewest_vertices() {
    const int* const last = std::end(kErrorLadder) - 1;
    const int least = least_around(centerline_, options_.max_error);
    const int* const first = std::min(std::lower_bound(std::begin(kErrorLadder), last, least), last);
    const int* best = std::min(std::lower_bound(first, last, options_.around), last);
    for (int finer = 0; !attempt(*best).point.within_budget && best < last && finer < kMostFiner; ++finer) ++best;
    for (const int step : {-1, 1}) {
      for (const int* next = best + step; next >= first && next <= last && better(*next, *best); next += step)
        best = next;
    }
  }

  bool better(int around, int than) { return better(attempt(around), attempt(than)); }

  bool better(const Trial& a, const Trial& b) const {
    if (a.point.within_budget != b.point.within_budget) return a.point.within_budget;
    if (budget_.kind == Budget::Kind::error) {
      if (a.unproven != b.unproven) return a.unproven < b.unproven;
      return a.point.vertices < b.point.vertices;
    }
    if (!a.point.within_budget) return cost(a.point) < cost(b.point);
    if (budget_.kind == Budget::Kind::vertices) return a.point.vertices > b.point.vertices;
    return a.point.options.around > b.point.options.around;
  }

  const Trial& attempt(int around) { return attempt(around, options_.ring_spacing); }

  const Trial& attempt(int around, double ring_spacing) {
    const Setting setting{around, ring_spacing};
    if (const auto known = trials_.find(setting); known != trials_.end()) return known->second;
    GenerateOptions options = options_;
    options.around = around;
    options.ring_spacing = ring_spacing;
    const auto begin = std::chrono::steady_clock::now();
    GenerateResult surface = generate_surface(centerline_, options, progress_);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    Trial trial;
    trial.unproven = surface.error.unproven_faces;
    trial.point.options = options;
    trial.point.vertices = surface.mesh.vertices.size();
    trial.point.seconds = seconds.count();
    trial.point.skewness = summarize_skewness(surface.mesh);
    trial.point.error = measure_deviation(surface.mesh, surface.binding, VesselField(centerline_, options.blend));
    trial.point.within_budget =
        budget_.kind == Budget::Kind::error ? trial.unproven == 0 : cost(trial.point) <= allowed();
    const Trial& kept = trials_.emplace(setting, std::move(trial)).first->second;
    if (!best_ || better(kept, trials_.at(best_->setting))) best_ = {setting, std::move(surface)};
    return kept;
  }

  BudgetedSurface result() {
    BudgetedSurface chosen;
    for (const auto& [setting, trial] : trials_) {
      if (setting == best_->setting) chosen.chosen = chosen.tried.size();
      chosen.tried.push_back(trial.point);
    }
    chosen.result = std::move(best_->surface);
    return chosen;
  }

  using Setting = std::pair<int, double>;  // vertices around, distance of rings
  struct Best {
    Setting setting;
    GenerateResult surface;
  };

  const Budget& budget_;
  const Centerline& centerline_;
  GenerateOptions options_;
  const Progress& progress_;
  std::map<Setting, Trial> trials_;
  std::optional<Best> best_;
};

}  // namespace

Budget parse_budget(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) throw unknown_budget(text);
  const std::string_view what = text.substr(0, equals), amount = text.substr(equals + 1);
  Budget budget;
  if (what == "error") {
    budget.kind = Budget::Kind::error;
    budget.error = parse_error_limit(amount);
    return budget;
  }
  const auto [value, unit] = parse_quantity(amount, text);
  if (what == "vertices" && unit.empty() && value >= 1 && value <= 1e12) {
    budget.vertices = static_cast<std::size_t>(value);
  } else if (what == "time" && (unit == "ms" || unit == "s")) {
    budget.kind = Budget::Kind::time;
    budget.seconds = unit == "s" ? value : value / 1000;
  } else {
    throw unknown_budget(text);
  }
  return budget;
}

std::string to_string(const Budget& budget) {
  switch (budget.kind) {
    case Budget::Kind::vertices:
      return "vertices=" + std::to_string(budget.vertices);
    case Budget::Kind::error:
      return "error=" + to_string(budget.error);
    case Budget::Kind::time:
      break;
  }
  return formatted("time=%gms", 1000 * budget.seconds);
}

BudgetedSurface generate_within(const Budget& budget, const Centerline& centerline, GenerateOptions options,
                                const Progress& progress) {
  return BudgetSearch(budget, centerline, options, progress).run();
}

}  // namespace vmesh

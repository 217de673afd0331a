#include "render/legend.h"

#include <algorithm>
#include <cmath>

#include "vmesh/core/text.h"

#include "render/color.h"
#include "render/stroke_font.h"

namespace vmesh {
namespace {

constexpr int kTicks = 6;

// Lengths in pixels, in proportion to the picture.
struct Layout {
  double text, bar_width, margin, top, bottom, left;
};

double text_height(int width, int height) { return std::max(6.0, 0.0145 * std::min(height, width)); }

double step_of(const std::vector<double>& ticks) { return ticks.size() > 1 ? ticks[1] - ticks[0] : 0; }

std::string category_label(double category) { return tick_label(category, 1); }

std::string more_label(std::size_t count) { return std::to_string(count) + " more"; }

std::vector<std::string> labels_of(const Legend& legend) {
  if (!legend.categories.empty()) {
    return {category_label(legend.categories.front()), category_label(legend.categories.back()),
            more_label(legend.categories.size())};
  }
  const auto ticks = legend_ticks(legend.low, legend.high, legend.integer, kTicks);
  std::vector<std::string> labels;
  for (const double tick : ticks) labels.push_back(tick_label(tick, step_of(ticks)));
  return labels;
}

Layout layout_of(const Legend& legend, int width, int height) {
  Layout layout{};
  layout.text = text_height(width, height);
  layout.bar_width = 1.6 * layout.text;
  layout.margin = 1.8 * layout.text;
  layout.top = 0.2 * height;
  layout.bottom = 0.8 * height;
  layout.left = width - legend_width(legend, width, height) + layout.margin;
  return layout;
}

void draw_scale(Canvas& canvas, const Legend& legend, const Layout& at, const Vec3& ink) {
  const double x = at.left, label_x = x + at.bar_width + at.text;
  const bool constant = !(legend.high > legend.low);
  for (int y = static_cast<int>(at.top); y < at.bottom; ++y) {
    const double t = constant ? 0.5 : 1 - (y + 0.5 - at.top) / (at.bottom - at.top);
    const double from = std::max<double>(y, at.top), to = std::min<double>(y + 1, at.bottom);
    canvas.fill({x, from}, {x + at.bar_width, to}, color_scale(t));
  }
  const auto ticks = legend_ticks(legend.low, legend.high, legend.integer, kTicks);
  for (const double tick : ticks) {
    const double t = constant ? 0.5 : (tick - legend.low) / (legend.high - legend.low);
    const double y = at.bottom + t * (at.top - at.bottom);
    canvas.stroke({x + at.bar_width, y}, {x + at.bar_width + 0.4 * at.text, y}, std::max(1.0, 0.08 * at.text), ink);
    draw_text(canvas, tick_label(tick, step_of(ticks)), {label_x, y + 0.5 * at.text}, at.text, ink);
  }
}

void draw_categories(Canvas& canvas, const Legend& legend, const Layout& at, const Vec3& ink) {
  const double row = 1.7 * at.text, label_x = at.left + at.bar_width + at.text;
  const auto rows = std::max<std::size_t>(1, static_cast<std::size_t>((at.bottom - at.top) / row));
  const bool all = legend.categories.size() <= rows;
  const std::size_t shown = all ? legend.categories.size() : rows - 1;
  double y = at.top;
  for (std::size_t i = 0; i < shown; ++i, y += row) {
    canvas.fill({at.left, y}, {at.left + at.bar_width, y + 1.3 * at.text}, category_color(legend.categories[i]));
    draw_text(canvas, category_label(legend.categories[i]), {label_x, y + 1.15 * at.text}, at.text, ink);
  }
  if (!all)
    draw_text(canvas, more_label(legend.categories.size() - shown), {label_x, y + 1.15 * at.text}, at.text, ink);
}

}  // namespace

std::vector<double> legend_ticks(double low, double high, bool integer, int wanted) {
  if (!(high > low)) return {low};
  const double rough = (high - low) / wanted;
  double step = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {2.0, 2.5, 2.0}) {  // 1, 2, 5, 10
    if (step < rough * 0.999) step *= factor;
  }
  if (integer) step = std::max(1.0, std::round(step));
  std::vector<double> ticks;
  const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  for (double k = first; k <= last && ticks.size() < 100; ++k) ticks.push_back(k == 0 ? 0 : k * step);
  if (ticks.empty()) ticks = {low, high};
  return ticks;
}

std::string tick_label(double value, double step) {
  const double size = std::max(std::abs(value), step);
  if (step == 0 || size >= 1e6 || step < 1e-4) return formatted("%.4g", value);
  return formatted("%.*f", std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9))), value);
}

int legend_width(const Legend& legend, int width, int height) {
  const double text = text_height(width, height);
  double labels = legend.has_missing ? text_width("no value", text) : 0;
  for (const auto& label : labels_of(legend)) labels = std::max(labels, text_width(label, text));
  const double below_name = (1.6 + 1.0) * text + labels;
  const double wanted = std::max(below_name, text_width(legend.name, text)) + 2 * 1.8 * text;
  return static_cast<int>(std::ceil(std::min(wanted, 0.4 * width)));
}

void draw_legend(Canvas& canvas, const Legend& legend, const Vec3& background) {
  const Layout at = layout_of(legend, canvas.width(), canvas.height());
  const Vec3 ink = background.sum() > 0.6 ? Vec3::Constant(0.02) : Vec3::Constant(0.85);
  const double x = at.left, label_x = x + at.bar_width + at.text;
  // A name too long for the column is set smaller.
  const double room = canvas.width() - x - 0.3 * at.margin;
  const double name_size = at.text * std::min(1.0, room / std::max(text_width(legend.name, at.text), 1.0));
  draw_text(canvas, legend.name, {x, at.top - 1.6 * at.text}, name_size, ink);

  legend.categories.empty() ? draw_scale(canvas, legend, at, ink) : draw_categories(canvas, legend, at, ink);
  if (legend.has_missing) {
    const double y = at.bottom + 1.5 * at.text;
    canvas.fill({x, y}, {x + at.bar_width, y + at.bar_width}, kNoValue);
    draw_text(canvas, "no value", {label_x, y + 0.5 * (at.bar_width + at.text)}, at.text, ink);
  }
}

}  // namespace vmesh

#include "vmesh/tuning/plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "vmesh/core/text.h"

namespace vmesh {
namespace {

constexpr double kWidth = 460, kHeight = 400;  // of one plot, with its margins
constexpr double kLeft = 70, kRight = 30, kTop = 40, kBottom = 50;
constexpr double kLegendLine = 18, kLegendColumn = 290, kMargin = 0.04;  // of an axis
// Distinguishable with colour blindness as well (Okabe and Ito 2008).
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                   "#56b4e9", "#000000", "#999999", "#8b5e3c", "#6a3d9a"};

// Curves beyond the last colour have the first again, with hollow points on dashed lines.
struct Style {
  std::string color;
  bool hollow = false;
};

std::string number(double value, const char* format = "%.2f") { return formatted(format, value); }

std::string escaped(const std::string& text) { return xml_escaped(text, "&<"); }

std::string dot(double x, double y, int radius, const Style& style) {
  const std::string fill = style.hollow ? "white\" stroke=\"" + style.color : style.color;
  return "<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"" + std::to_string(radius) + "\" fill=\"" +
         fill + "\"/>\n";
}

std::string text_at(double x, double y, const std::string& text, const std::string& attributes = "") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + attributes + ">" + escaped(text) + "</text>\n";
}

bool drawable(const std::pair<double, double>& point) {
  return point.first > 0 && point.second > 0 && std::isfinite(point.first) && std::isfinite(point.second);
}

// A logarithmic axis from pixel `begin` to pixel `end`.
struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = -low;  // decadic logarithms
  double begin = 0, end = 0;

  void extend(double value) {
    low = std::min(low, std::log10(value));
    high = std::max(high, std::log10(value));
  }
  void settle() {
    if (!(low <= high)) low = 0, high = 1;
    const double pad = std::max(kMargin * (high - low), 0.02);
    low -= pad;
    high += pad;
  }
  double operator()(double value) const { return begin + (end - begin) * (std::log10(value) - low) / (high - low); }
  // 1, 2 and 5 of every decade, or only the decades if there are many.
  std::vector<double> ticks() const {
    std::vector<double> ticks;
    for (int decade = static_cast<int>(std::floor(low)); decade <= std::ceil(high); ++decade) {
      for (const double digit : {1, 2, 5}) {
        const double value = digit * std::pow(10, decade);
        if (std::log10(value) < low || std::log10(value) > high || (digit > 1 && high - low > 3)) continue;
        ticks.push_back(value);
      }
    }
    return ticks;
  }
};

class Panel {
 public:
  Panel(const LogPlot& plot, double x, const std::map<std::string, Style>& styles) : plot_(plot), styles_(styles) {
    x_.begin = x + kLeft;
    x_.end = x + kWidth - kRight;
    y_.begin = kHeight - kBottom;
    y_.end = kTop;
    for (const LogPlot::Curve& curve : plot.curves) {
      for (const auto& point : curve.points) {
        if (!drawable(point)) continue;
        x_.extend(point.first);
        y_.extend(point.second);
      }
    }
    x_.settle();
    y_.settle();
  }

  std::string svg() const {
    std::string svg = axes();
    for (const LogPlot::Curve& curve : plot_.curves) svg += drawn(curve);
    return svg;
  }

 private:
  std::string axes() const {
    std::string svg = "<rect x=\"" + number(x_.begin) + "\" y=\"" + number(y_.end) + "\" width=\"" +
                      number(x_.end - x_.begin) + "\" height=\"" + number(y_.begin - y_.end) +
                      "\" fill=\"none\" stroke=\"#444\"/>\n";
    for (const double tick : x_.ticks()) {
      svg += line(x_(tick), y_.begin, x_(tick), y_.end);
      svg += text_at(x_(tick), y_.begin + 16, number(tick, "%g"), "text-anchor=\"middle\"");
    }
    for (const double tick : y_.ticks()) {
      svg += line(x_.begin, y_(tick), x_.end, y_(tick));
      svg += text_at(x_.begin - 6, y_(tick) + 4, number(tick, "%g"), "text-anchor=\"end\"");
    }
    const double middle = 0.5 * (x_.begin + x_.end), height = 0.5 * (y_.begin + y_.end), side = x_.begin - kLeft + 16;
    svg += text_at(middle, kTop - 14, plot_.title, "text-anchor=\"middle\" font-weight=\"bold\"");
    svg += text_at(middle, kHeight - 12, plot_.x_label, "text-anchor=\"middle\"");
    svg += text_at(side, height, plot_.y_label,
                   "text-anchor=\"middle\" transform=\"rotate(-90 " + number(side) + " " + number(height) + ")\"");
    return svg;
  }

  static std::string line(double x0, double y0, double x1, double y1) {
    return "<line x1=\"" + number(x0) + "\" y1=\"" + number(y0) + "\" x2=\"" + number(x1) + "\" y2=\"" + number(y1) +
           "\" stroke=\"#ddd\"/>\n";
  }

  std::string drawn(const LogPlot::Curve& curve) const {
    const Style& style = styles_.at(curve.name);
    std::string path, dots;
    for (const auto& point : curve.points) {
      if (!drawable(point)) continue;
      const double x = x_(point.first), y = y_(point.second);
      path += (path.empty() ? "" : " ") + number(x) + "," + number(y);
      dots += dot(x, y, 3, style);
    }
    if (!curve.joined) return dots;
    const std::string dashes = style.hollow ? " stroke-dasharray=\"4 3\"" : "";
    return "<polyline points=\"" + path + "\" fill=\"none\" stroke=\"" + style.color + "\" stroke-width=\"1.5\"" +
           dashes + "/>\n" + dots;
  }

  const LogPlot& plot_;
  const std::map<std::string, Style>& styles_;
  Axis x_, y_;
};

}  // namespace

std::string svg_of(const std::vector<LogPlot>& plots) {
  std::vector<std::string> names;
  std::map<std::string, Style> styles;
  for (const LogPlot& plot : plots) {
    for (const LogPlot::Curve& curve : plot.curves) {
      const std::size_t n = names.size(), count = std::size(kColors);
      if (!styles.emplace(curve.name, Style{kColors[n % count], n / count % 2 == 1}).second) continue;
      names.push_back(curve.name);
    }
  }
  const double width = kWidth * static_cast<double>(std::max<std::size_t>(1, plots.size()));
  const auto columns = static_cast<std::size_t>(std::max(1.0, std::floor(width / kLegendColumn)));
  const std::size_t rows = (names.size() + columns - 1) / columns;
  const double height = kHeight + kLegendLine * static_cast<double>(rows) + 10;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(width) + "\" height=\"" +
                    number(height) + "\" font-family=\"sans-serif\" font-size=\"12\">\n" +
                    "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (std::size_t i = 0; i < plots.size(); ++i) svg += Panel(plots[i], kWidth * static_cast<double>(i), styles).svg();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double x = 20 + kLegendColumn * static_cast<double>(i % columns);
    const double y = kHeight + kLegendLine * static_cast<double>(i / columns) + 8;
    svg += dot(x, y - 4, 4, styles.at(names[i]));
    svg += text_at(x + 10, y, names[i]);
  }
  return svg + "</svg>\n";
}

}  // namespace vmesh

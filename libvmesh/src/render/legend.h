#pragma once

#include <string>
#include <vector>

#include "render/canvas.h"

namespace vmesh {

/// The contents of a legend: the attribute's name, the values at both ends of the colour scale or the labels, and
/// whether some elements have no value.
struct Legend {
  std::string name;
  double low = 0, high = 1;
  bool integer = false;
  bool has_missing = false;
  std::vector<double> categories;  ///< ascending; empty: a scale from `low` to `high`
};

/// Round numbers in [low, high], about `wanted` of them; the value itself when low equals high.
std::vector<double> legend_ticks(double low, double high, bool integer, int wanted);

/// `value` with as many decimals as ticks at intervals of `step` need.
std::string tick_label(double value, double step);

/// Columns that the legend occupies at the right side of a picture of this size.
int legend_width(const Legend& legend, int width, int height);

/// Draws the scale with its ticks, or as many of the first categories as fit and how many there are more.
void draw_legend(Canvas& canvas, const Legend& legend, const Vec3& background);

}  // namespace vmesh

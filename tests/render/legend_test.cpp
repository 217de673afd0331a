#include "render/legend.h"

#include <gtest/gtest.h>

#include "render/color.h"
#include "render/stroke_font.h"

namespace vmesh {
namespace {

TEST(LegendTicks, AreRoundNumbersWithinTheRange) {
  EXPECT_EQ(legend_ticks(0.5, 6.5, false, 6), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(legend_ticks(-10, 10, false, 5), (std::vector<double>{-10, -5, 0, 5, 10}));
  EXPECT_EQ(legend_ticks(0, 2, true, 6), (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(legend_ticks(3, 3, false, 6), (std::vector<double>{3}));
  for (const double scale : {1e-9, 1e-3, 1.0, 1e5, 1e12}) {
    const auto ticks = legend_ticks(0.123 * scale, 0.789 * scale, false, 6);
    EXPECT_GE(ticks.size(), 3u);
    EXPECT_LE(ticks.size(), 8u);
    EXPECT_GE(ticks.front(), 0.123 * scale);
    EXPECT_LE(ticks.back(), 0.789 * scale);
  }
}

TEST(LegendLabels, HaveTheDecimalsTheyNeed) {
  EXPECT_EQ(tick_label(2, 1), "2");
  EXPECT_EQ(tick_label(0.4, 0.2), "0.4");
  EXPECT_EQ(tick_label(1, 0.05), "1.00");
  EXPECT_EQ(tick_label(3000, 500), "3000");
  EXPECT_EQ(tick_label(2e-7, 1e-7), "2e-07");
  EXPECT_EQ(tick_label(3e8, 1e8), "3e+08");
  EXPECT_EQ(tick_label(2.5, 0), "2.5");
}

TEST(LegendColours, GrowLighterFromEndToEnd) {
  double last = -1;
  for (int i = 0; i <= 100; ++i) {
    const Vec3 light = color_scale(i / 100.0);
    const double luminance = 0.2126 * light.x() + 0.7152 * light.y() + 0.0722 * light.z();
    EXPECT_GT(luminance, last);
    last = luminance;
  }
}

TEST(LegendColours, OfCategoriesNearInNumberAreFarApart) {
  for (int label = -3; label < 300; ++label) {
    const Color a = srgb_from_linear(category_color(label));
    for (int other = label + 1; other < label + 10; ++other) {
      const Color b = srgb_from_linear(category_color(other));
      int difference = 0;
      for (std::size_t i = 0; i < 3; ++i) difference = std::max(difference, std::abs(a[i] - b[i]));
      EXPECT_GT(difference, 30) << label << " and " << other;
    }
  }
  EXPECT_EQ(category_color(7), category_color(7.2));
}

TEST(LegendText, DrawsEveryCharacter) {
  for (char c = '!'; c <= '~'; ++c) {
    Canvas canvas(40, 40, Vec3::Ones());
    draw_text(canvas, std::string_view(&c, 1), {10, 28}, 18, Vec3::Zero());
    const Image image = canvas.image();
    int dark = 0;
    for (const Color& pixel : image.pixels) dark += pixel[0] < 100;
    EXPECT_GT(dark, 3) << c;
    EXPECT_GT(text_width(std::string_view(&c, 1), 18), -1e-9) << c;
  }
  EXPECT_GT(text_width("radius", 10), text_width("rad", 10));
  Canvas canvas(40, 40, Vec3::Ones());
  EXPECT_NO_THROW(draw_text(canvas, "\xc3\xa9\x01", {-10, 50}, 18, Vec3::Zero()));  // not ASCII, off the picture
}

}  // namespace
}  // namespace vmesh

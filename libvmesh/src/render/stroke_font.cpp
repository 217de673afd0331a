#include "render/stroke_font.h"

#include <algorithm>
#include <array>

namespace vmesh {
namespace {

// Glyphs as lines on a grid: a point is two digits, x from 0 to 4 and y from 0 to 9; blanks join the points of a line,
// commas start another one. Baseline y = 2, small letters to 6, capitals to 8, descenders to 0.
constexpr double kBaseline = 2, kCapHeight = 6, kGap = 1.9, kBlank = 2.2, kThickness = 0.85;
constexpr std::array<std::string_view, 95> kGlyphs = {
    "",                                                 // blank
    "28 24,22 22",                                      // !
    "18 16,38 36",                                      // "
    "12 18,32 38,04 44,06 46",                          // #
    "47 38 18 07 06 15 35 44 43 32 12 03,29 21",        // $
    "02 48,08 18 17 07 08,33 43 42 32 33",              // %
    "42 07 18 27 26 04 03 12 22 44",                    // &
    "28 26",                                            // '
    "38 26 24 32",                                      // (
    "18 26 24 12",                                      // )
    "27 23,06 44,46 04",                                // *
    "27 23,05 45",                                      // +
    "22 11",                                            // ,
    "05 35",                                            // -
    "22 22",                                            // .
    "02 48",                                            // /
    "18 07 03 12 32 43 47 38 18",                       // 0
    "06 28 22",                                         // 1
    "07 18 38 47 46 02 42",                             // 2
    "07 18 38 47 46 35 15,35 44 43 32 12 03",           // 3
    "32 38 04 44",                                      // 4
    "48 08 05 35 44 43 32 12 03",                       // 5
    "47 38 18 07 03 12 32 43 44 35 15 04",              // 6
    "08 48 12",                                         // 7
    "15 06 07 18 38 47 46 35 15 04 03 12 32 43 44 35",  // 8
    "46 35 15 06 07 18 38 47 43 32 12 03",              // 9
    "26 26,23 23",                                      // :
    "26 26,23 11",                                      // ;
    "47 05 43",                                         // <
    "06 46,04 44",                                      // =
    "07 45 03",                                         // >
    "07 18 38 47 46 25 24,22 22",                       // ?
    "35 26 15 14 23 34 35 33 43 47 38 18 07 03 12 42",  // @
    "02 28 42,14 34",                                   // A
    "02 08 38 47 46 35 05,35 44 43 32 02",              // B
    "47 38 18 07 03 12 32 43",                          // C
    "02 08 28 46 44 22 02",                             // D
    "48 08 02 42,05 35",                                // E
    "48 08 02,05 35",                                   // F
    "47 38 18 07 03 12 32 43 45 25",                    // G
    "08 02,48 42,05 45",                                // H
    "28 22",                                            // I
    "38 33 22 12 03",                                   // J
    "08 02,48 04,16 42",                                // K
    "08 02 42",                                         // L
    "02 08 25 48 42",                                   // M
    "02 08 42 48",                                      // N
    "18 07 03 12 32 43 47 38 18",                       // O
    "02 08 38 47 46 35 05",                             // P
    "18 07 03 12 32 43 47 38 18,24 42",                 // Q
    "02 08 38 47 46 35 05,25 42",                       // R
    "47 38 18 07 06 15 35 44 43 32 12 03",              // S
    "08 48,28 22",                                      // T
    "08 03 12 32 43 48",                                // U
    "08 22 48",                                         // V
    "08 12 26 32 48",                                   // W
    "08 42,02 48",                                      // X
    "08 25 48,25 22",                                   // Y
    "08 48 02 42",                                      // Z
    "38 18 12 32",                                      // [
    "08 42",                                            // backslash
    "18 38 32 12",                                      // ]
    "06 28 46",                                         // ^
    "01 41",                                            // _
    "18 27",                                            // `
    "06 26 35 32,34 14 03 12 22 33",                    // a
    "08 02,05 16 26 35 33 22 12 03",                    // b
    "35 26 16 05 03 12 22 33",                          // c
    "38 32,35 26 16 05 03 12 22 33",                    // d
    "04 34 35 26 16 05 03 12 22 33",                    // e
    "28 17 12,06 26",                                   // f
    "36 31 20 10 01,35 26 16 05 03 12 22 33",           // g
    "08 02,05 16 26 35 32",                             // h
    "26 22,28 28",                                      // i
    "26 21 10,28 28",                                   // j
    "08 02,36 04,15 32",                                // k
    "28 22",                                            // l
    "02 06,05 16 25 22,25 36 45 42",                    // m
    "02 06,05 16 26 35 32",                             // n
    "16 05 03 12 22 33 35 26 16",                       // o
    "00 06,05 16 26 35 33 22 12 03",                    // p
    "30 36,35 26 16 05 03 12 22 33",                    // q
    "02 06,04 16 26",                                   // r
    "35 26 16 05 14 24 33 22 12 03",                    // s
    "18 13 22,06 26",                                   // t
    "06 03 12 22 33,36 32",                             // u
    "06 22 46",                                         // v
    "06 12 25 32 46",                                   // w
    "06 32,02 36",                                      // x
    "06 22,46 10 00",                                   // y
    "06 36 02 32",                                      // z
    "38 27 26 15 24 23 32",                             // {
    "29 21",                                            // |
    "18 27 26 35 24 23 12",                             // }
    "04 15 34 45",                                      // ~
};

std::string_view glyph_of(char c) { return kGlyphs[static_cast<std::size_t>((c < ' ' || c > '~' ? '?' : c) - ' ')]; }

struct Extent {
  double left = 0, right = 0;
};

Extent extent_of(std::string_view glyph) {
  if (glyph.empty()) return {0, kBlank - kGap};
  Extent extent{4, 0};
  for (std::size_t i = 0; i < glyph.size(); i += 3) {
    extent.left = std::min<double>(extent.left, glyph[i] - '0');
    extent.right = std::max<double>(extent.right, glyph[i] - '0');
  }
  return extent;
}

}  // namespace

double text_width(std::string_view text, double height) {
  double width = -kGap;
  for (const char c : text) width += extent_of(glyph_of(c)).right - extent_of(glyph_of(c)).left + kGap;
  return std::max(width, 0.0) * height / kCapHeight;
}

void draw_text(Canvas& canvas, std::string_view text, const Vec2& baseline, double height, const Vec3& light) {
  const double unit = height / kCapHeight;
  double pen = 0;
  for (const char c : text) {
    const std::string_view glyph = glyph_of(c);
    const Extent extent = extent_of(glyph);
    const auto point = [&](std::size_t i) {
      const double x = pen + (glyph[i] - '0') - extent.left, y = glyph[i + 1] - '0' - kBaseline;
      return Vec2(baseline + unit * Vec2(x, -y));
    };
    for (std::size_t i = 0; i + 4 < glyph.size(); i += 3) {
      if (glyph[i + 2] == ' ') canvas.stroke(point(i), point(i + 3), kThickness * unit, light);
    }
    pen += extent.right - extent.left + kGap;
  }
}

}  // namespace vmesh

#pragma once

#include <string_view>

#include "render/canvas.h"

namespace vmesh {

// A stroke font in 150 lines of code. VTK's text renderer would need nine more shared libraries (9.6 MB, which alone
// take 20 ms whenever the command starts), avoids OpenGL only with hand-picked components, and rasterises with the
// installed FreeType, so that pictures would not be the same bytes everywhere; builds without VTK would still need this
// font.

/// Width of a line of text whose capitals are `height` pixels high.
double text_width(std::string_view text, double height);

/// Draws a line of text from the left end of its baseline. ASCII; other bytes appear as question marks.
void draw_text(Canvas& canvas, std::string_view text, const Vec2& baseline, double height, const Vec3& light);

}  // namespace vmesh

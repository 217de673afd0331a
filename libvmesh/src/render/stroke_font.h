#pragma once

#include <string_view>

#include "render/canvas.h"

namespace vmesh {

// A font of lines, 150 of code. VTK's text renderer would need nine more shared libraries (9.6 MB, loaded whenever the
// command starts: 20 ms by themselves), does without OpenGL only by choosing its parts by hand, rasterises as the
// FreeType that is installed does, so that pictures would no longer be the same bytes everywhere, and builds without VTK
// would need this font all the same.

/// Width of a line of text whose capitals are `height` pixels high.
double text_width(std::string_view text, double height);

/// Draws a line of text from the left end of its baseline. ASCII; other bytes appear as question marks.
void draw_text(Canvas& canvas, std::string_view text, const Vec2& baseline, double height, const Vec3& light);

}  // namespace vmesh

#pragma once

#include <string_view>

#include "render/canvas.h"

namespace vmesh {

/// Width of a line of text whose capitals are `height` pixels high.
double text_width(std::string_view text, double height);

/// Draws a line of text from the left end of its baseline. ASCII; other bytes appear as question marks.
void draw_text(Canvas& canvas, std::string_view text, const Vec2& baseline, double height, const Vec3& light);

}  // namespace vmesh

// Eigen includes it and uses nothing of it; emscripten has none.
#pragma once

#pragma once

#include "vmesh/surface/generate.h"

namespace vmesh {

/// The options as they are used around `centerline`: with as many vertices around as a limit on the error asks for.
/// Throws InvalidInput for options out of range, a centerline of a scale that cannot be computed with (check_scale()),
/// and one that asks for more vertices than are allowed.
GenerateOptions settled(const GenerateOptions& given, const Centerline& centerline);

/// Throws Unsupported where a surface would need more memory than is free.
void require_memory_for(const Centerline& centerline, const GenerateOptions& options);

}  // namespace vmesh

#pragma once

#include "vmesh/surface/generate.h"

namespace vmesh {

/// The options as used for `centerline`: with as many vertices around as an error limit needs. Throws InvalidInput for
/// options out of range, a centerline whose scale cannot be handled (check_scale()), and one that needs more vertices
/// than allowed.
GenerateOptions settled(const GenerateOptions& given, const Centerline& centerline);

/// Throws Unsupported where a surface would need more memory than is free.
void require_memory_for(const Centerline& centerline, const GenerateOptions& options);

}  // namespace vmesh

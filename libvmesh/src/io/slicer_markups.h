#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "vmesh/io/centerline_io.h"

namespace vmesh::io {

/// The curves and lines in a Markups file of 3D Slicer (its schema "markups", version 1): a vessel each. The radius is
/// the measurement "Radius" of the control points, in its own unit if it has one. Throws InvalidInput.
RawCenterline read_markups(const nlohmann::json& document, const std::string& source,
                           const CenterlineReadOptions& options);

}  // namespace vmesh::io

// The work that JavaScript asks for.
#pragma once

#include <memory>
#include <string>

#include "options.h"
#include "report/json.h"

namespace vmesh::wasm {

using tool::Json;

std::shared_ptr<const CenterlineObject> read(const ReadRequest& request);

/// The surface that produce() makes, whether it is sound or not.
std::unique_ptr<SurfaceObject> generate(std::shared_ptr<const CenterlineObject> centerline,
                                        const ProductionOptions& options, const Progress& progress);

/// What is known of each, and of the surface as a page shows it (schema vmesh.page/1).
Json describe(const CenterlineObject& centerline);
Json describe(const SurfaceObject& surface);
Json page_about(const SurfaceObject& surface);

}  // namespace vmesh::wasm

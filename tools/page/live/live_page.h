// A page in which a tree moves under the reader's hands, in one self-contained HTML file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vmesh/deform/simulation.h"
#include "vmesh/deform/surface_binding.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::tool {

struct LivePage {
  std::filesystem::path tree, surface;  ///< files, for the title and the command that plays a saved scene
  const Centerline& centerline;
  const TriMesh& mesh;
  const std::vector<Vec3>& normals;
  const std::vector<SurfacePlace>& places;
  Material material;
  SimulationOptions options;
  std::vector<Index> fix, clamp;  ///< nodes held from the start
  std::optional<ContactOptions> contact;
  std::optional<TissueProperties> tissue;  ///< everywhere
};

/// The whole page, UTF-8. Deterministic. Only in a build with emscripten and three.js.
std::string to_html(const LivePage& page);

}  // namespace vmesh::tool

// What JavaScript holds.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vmesh/io/centerline_io.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/production/produce.h"
#include "vmesh/surface/deviation.h"

namespace vmesh::wasm {

struct CenterlineObject {
  Centerline centerline;
  std::string title;  ///< name of the file
  std::vector<EndSection> end_sections = {};
  std::vector<std::string> cleaning = {};       ///< what was done to make it valid
  std::vector<std::string> warnings = {};       ///< of the reader
  std::vector<std::string> place_of_node = {};  ///< in the file
};

struct SurfaceObject {
  std::shared_ptr<const CenterlineObject> centerline;
  ProductionOptions options;
  std::string options_text;  ///< as they were given
  Production production;
  Deviation deviation;  ///< from the vessels it was grown around
  std::vector<std::string> warnings;
  MeshAttributes attributes;  ///< those that files get

  const GenerateResult& result() const { return production.result; }
};

}  // namespace vmesh::wasm

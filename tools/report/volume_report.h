#pragma once

#include <filesystem>

#include "vmesh/io/volume_io.h"
#include "vmesh/solid/make_volume.h"

#include "command_line/console.h"
#include "report/json.h"

namespace vmesh::tool {

/// Everything `vmesh volume` reports. Schema "vmesh.volume/1".
struct VolumeReport {
  std::filesystem::path input;
  std::string input_sha256;
  std::string options;  ///< how it was made
  const VolumeOptions* volume_options = nullptr;
  const VesselWall* wall = nullptr;
  const VolumeResult* result = nullptr;
  VolumeMeasures measures;
  std::vector<StageTime> stages;  ///< of the whole run
};

Json to_json(const VolumeReport& report);

/// Figures and thin places.
void log_volume(const VolumeReport& report, Console& console);

}  // namespace vmesh::tool

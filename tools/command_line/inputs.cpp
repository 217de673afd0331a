#include "command_line/inputs.h"

#include <algorithm>

#include "command_line/outputs.h"
#include "command_line/usage_error.h"

namespace vmesh::tool {
namespace {

bool is_vtp(const std::filesystem::path& path) { return extension_of(path) == ".vtp"; }

bool has_surface_extension(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".ply" || extension == ".stl" || extension == ".obj" || extension == ".off";
}

bool is_length(const std::string& attribute) {
  return attribute == "radius" || attribute == "distance" || attribute == "volume_distance";
}

void scale(LoadedSurface& surface, double factor) {
  for (Vec3& p : surface.mesh.vertices) p *= factor;
  for (auto* attributes : {&surface.attributes.vertex, &surface.attributes.face})
    for (MeshAttribute& attribute : *attributes)
      if (is_length(attribute.name))
        for (double& value : attribute.values) value *= factor;
}

void convert_to_internal(LoadedSurface& surface, const InputArguments& input) {
  if (input.unit) surface.unit = *input.unit;
  if (input.space) surface.space = *input.space;
  const std::string name = input.path.string();
  if (surface.unit == LengthUnit::unknown) {
    surface.warnings.push_back(name + ": names no unit; millimetres are taken (--unit overrides)");
    surface.unit = LengthUnit::mm;
  }
  if (surface.space == Space::unknown) {
    surface.warnings.push_back(name + ": names no patient frame; LPS is taken (--space overrides)");
    surface.space = Space::lps;
  }
  if (surface.unit != LengthUnit::mm) scale(surface, millimetres_per(surface.unit));
  if (surface.space == Space::ras)
    for (Vec3& p : surface.mesh.vertices) p = Vec3(-p.x(), -p.y(), p.z());
  surface.unit = LengthUnit::mm;
  surface.space = Space::lps;
}

}  // namespace

RawCenterline load_raw_centerline(const InputArguments& input, std::vector<std::string>& warnings) {
  RawCenterline raw = read_centerline(input.path);
  warnings.insert(warnings.end(), raw.warnings.begin(), raw.warnings.end());
  return convert_to_internal(std::move(raw), input.unit, input.space, warnings);
}

LoadedSurface load_surface(const InputArguments& input) {
  LoadedSurface surface = read_surface(input.path);
  convert_to_internal(surface, input);
  return surface;
}

LoadedCenterline load_clean_centerline(const InputArguments& input, Console& console) {
  CenterlineLoadOptions options;
  options.unit = input.unit;
  options.space = input.space;
  LoadedCenterline loaded = load_centerline(input.path, options);
  console.warn(loaded.warnings);
  for (const std::string& line : loaded.cleaned.report.summary()) console.log("cleaning: " + line);
  return loaded;
}

LoadedImage load_image(const InputArguments& input, Console& console) {
  if (input.unit || input.space)
    throw UsageError(input.path.string() + ": an image says where it lies; --unit and --space do not apply");
  LoadedImage loaded = read_image(input.path);
  console.warn(loaded.warnings);
  return loaded;
}

AnyInput load_any(const InputArguments& input, std::vector<std::string>& warnings) {
  if (is_vtp(input.path) || has_surface_extension(input.path)) {
    try {
      LoadedSurface surface = load_surface(input);
      warnings.insert(warnings.end(), surface.warnings.begin(), surface.warnings.end());
      return surface;
    } catch (const InvalidInput&) {
      if (!is_vtp(input.path)) throw;  // a VTP without faces may be a centerline
    }
  }
  return load_raw_centerline(input, warnings);
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& input) {
  if (extension_of(input) == ".csv") return {input, csv_segments_path(input)};
  return {input};
}

}  // namespace vmesh::tool

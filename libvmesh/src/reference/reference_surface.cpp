#include "vmesh/reference/reference_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"
#include "vmesh/image/contour.h"
#include "vmesh/image/image_filters.h"
#include "vmesh/mesh/components.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/reference/sampled_field.h"

namespace vmesh {
namespace {

/// The values other than 0, ascending; at most `most` of them.
std::set<float> labels_of(const VoxelImage& image, std::size_t most) {
  std::set<float> labels;
  float last = 0;
  for (const float value : image.values) {
    if (value == 0 || value == last) continue;
    last = value;
    labels.insert(value);
    if (labels.size() == most) break;
  }
  return labels;
}

std::string list_of(const VoxelImage& image) { return list_of_values(labels_of(image, kListedValues + 1)); }

double count_of(const std::array<std::size_t, 3>& size) {
  return static_cast<double>(size[0]) * static_cast<double>(size[1]) * static_cast<double>(size[2]);
}

/// For a mask, and the crop of it.
void check_memory_for_mask(const VoxelImage& image) {
  const double voxels = count_of(image.size);
  require_memory(2 * sizeof(float) * voxels, "a mask of " + std::to_string(image.values.size()) + " voxels",
                 "crop the image to the vessels");
}

/// For the resampled or smoothed image, and its contour.
void check_memory_for_contour(const VoxelImage& image, const ReferenceOptions& options) {
  const double voxels = options.spacing > 0 ? count_of(resampled_size(image, options.spacing)) : count_of(image.size);
  std::ostringstream what;
  what << "a surface from an image of " << voxels << " voxels";
  require_memory((sizeof(float) + kContourBytesPerVoxel) * voxels, what.str(),
                 options.spacing > 0 ? "choose a larger spacing" : "resample it to a larger spacing, or crop it");
}

PreparedImage mask_scene(const VoxelImage& image, VoxelImage mask) {
  PreparedImage scene{std::move(mask), 0.5, true};
  if (std::find(scene.image.values.begin(), scene.image.values.end(), 1.0f) == scene.image.values.end())
    throw InvalidInput("no voxel is inside: " + list_of(image) + "; choose a label or a threshold that occurs");
  return scene;
}

PreparedImage scene_of(const LoadedImage& loaded, const ReferenceOptions& options) {
  const VoxelImage& image = loaded.image;
  if (!options.labels.empty()) return mask_scene(image, binary_mask(image, options.labels));
  if (options.threshold) {
    const double highest = *std::max_element(image.values.begin(), image.values.end());
    if (highest >= *options.threshold) return {image, *options.threshold, false};
    throw InvalidInput("no voxel is inside: the highest value is " + std::to_string(highest) +
                       "; choose a lower threshold");
  }
  const std::set<float> labels = labels_of(image, 2);
  if (labels.size() > 1)
    throw InvalidInput("there is more than one value besides 0 (" + list_of(image) +
                       "); choose one with --label, or --threshold for grey values");
  return mask_scene(image, binary_mask(image, {labels.empty() ? 1.0 : *labels.begin()}));
}

/// How far from inside voxels values can matter (mm).
double margin_of(const VoxelImage& image, const ReferenceOptions& options) {
  return 2 * image.spacing().maxCoeff() + 2 * options.spacing + 4 * options.smooth;
}

TriMesh largest_component(TriMesh mesh, std::size_t& count) {
  std::vector<TriMesh> parts = split_components(mesh);
  count = parts.size();
  if (count == 1) return mesh;
  std::size_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double volume = enclosed_volume(parts[p]);
    if (volume <= most) continue;
    most = volume;
    best = p;
  }
  return std::move(parts[best]);
}

ReferenceSurface contour_scene(PreparedImage scene, const ReferenceOptions& options) {
  if (options.binary) {
    scene.image = binary_mask(scene.image, scene.isovalue, std::numeric_limits<double>::infinity());
    scene.isovalue = 0.5;
    scene.binary = true;
  }
  ReferenceSurface result;
  result.binary = scene.binary;
  result.spacing = scene.image.spacing();
  TriMesh mesh = contour(scene.image, scene.isovalue);
  if (options.all_components) {
    result.components = split_components(mesh).size();
    result.mesh = std::move(mesh);
  } else {
    result.mesh = largest_component(std::move(mesh), result.components);
  }
  return result;
}

}  // namespace

std::string list_of_values(const std::set<float>& values) {
  if (values.empty()) return "all its voxels are 0";
  std::ostringstream text;
  text << "it holds ";
  std::size_t count = 0;
  for (const float value : values) {
    if (count == kListedValues) {
      text << " ...";
      break;
    }
    text << (count++ ? ", " : "") << value;
  }
  return text.str();
}

ImageReadOptions read_options_of(const ReferenceOptions& options) {
  return {options.segments, options.labels, options.voxel_size};
}

ReferenceOptions with_labels(ReferenceOptions options, const std::vector<ImageSegment>& segments) {
  for (const double value : values_of(options.segments, segments)) options.labels.push_back(value);
  options.segments.clear();
  return options;
}

void check(const ReferenceOptions& options) {
  if (!(options.labels.empty() && options.segments.empty()) && options.threshold)
    throw InvalidInput("a label and a threshold exclude each other; give one");
  if (!(options.spacing >= 0) || !(options.smooth >= 0)) throw InvalidInput("spacing and smoothing are 0 or more mm");
}

PreparedImage prepared_image(const LoadedImage& image, const ReferenceOptions& options) {
  check(options);
  check_memory_for_mask(image.image);
  PreparedImage scene = scene_of(image, with_labels(options, image.segments));
  scene.image = cropped_to(scene.image, scene.isovalue, margin_of(scene.image, options));
  check_memory_for_contour(scene.image, options);
  if (options.spacing > 0) {
    scene.image = resampled(scene.image, options.spacing);
    scene.binary = false;
  }
  if (options.smooth > 0) {
    scene.image = smoothed(scene.image, options.smooth);
    scene.binary = false;
  }
  return scene;
}

ReferenceSurface reference_surface(const LoadedImage& image, const ReferenceOptions& options) {
  return contour_scene(prepared_image(image, options), options);
}

ReferenceSurface reference_surface(const Centerline& centerline, double voxel, const ReferenceOptions& options) {
  check(options);
  PreparedImage scene{sample_field(centerline, voxel), 0, false};
  if (options.smooth > 0) scene.image = smoothed(scene.image, options.smooth);
  return contour_scene(std::move(scene), options);
}

}  // namespace vmesh

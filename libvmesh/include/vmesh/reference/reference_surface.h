#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/image/image_io.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// How to make a surface from an image. Steps in this order: inside or outside, resampling, smoothing, contouring,
/// components.
struct ReferenceOptions {
  /// Voxels of these values are inside. Without labels and threshold: non-zero voxels, provided that the image has only
  /// one value besides 0.
  std::vector<double> labels;
  /// The same by the names of segments, in files that name them.
  std::vector<std::string> segments = {};
  /// Sides of a voxel (mm) where the file does not tell them: TIFF.
  std::optional<Vec3> voxel_size = std::nullopt;
  /// Voxels of at least this value are inside; the image's own values are contoured. Not together with `labels`.
  std::optional<double> threshold;
  /// Side of cubic voxels to resample to (mm); 0: the image's own voxels.
  double spacing = 0;
  /// Standard deviation of a Gaussian to smooth with (mm); 0: none.
  double smooth = 0;
  /// Contour only inside and outside instead of values: a staircase, with better triangles.
  bool binary = false;
  /// Keep all components, cavities included, instead of the one that encloses the largest volume.
  bool all_components = false;
};

/// A marching-cubes surface: closed, manifold, oriented, in LPS and mm.
struct ReferenceSurface {
  TriMesh mesh;
  bool binary = false;          ///< contour of inside and outside; else of grey values
  std::size_t components = 0;   ///< of the contour, before any were removed
  Vec3 spacing = Vec3::Zero();  ///< of the voxels contoured (mm)
};

/// "it holds 1, 2, 5": the values of an image besides 0, for messages; no more than kListedValues of them.
std::string list_of_values(const std::set<float>& values);
inline constexpr std::size_t kListedValues = 20;

/// What to read of an image for these options.
ImageReadOptions read_options_of(const ReferenceOptions& options);

/// The options with labels instead of the names of segments. Throws InvalidInput for one that is not there.
ReferenceOptions with_labels(ReferenceOptions options, const std::vector<ImageSegment>& segments);

/// Throws InvalidInput for options out of range, or that exclude each other.
void check(const ReferenceOptions& options);

/// An image to be contoured at `isovalue`: cropped to what is inside and as much around it as matters, resampled and
/// smoothed.
struct PreparedImage {
  VoxelImage image;
  double isovalue = 0;
  bool binary = false;  ///< the values are 0 and 1
};
/// Throws what reference_surface() throws.
PreparedImage prepared_image(const LoadedImage& image, const ReferenceOptions& options);

/// Throws InvalidInput for options out of range, an image with several labels and no choice, and if nothing is inside
/// (listing the labels); Unsupported if there is not enough free memory for the image to be contoured.
ReferenceSurface reference_surface(const LoadedImage& image, const ReferenceOptions& options = {});

/// The vessel volume of a centerline (plain union of round cones), sampled on voxels of `voxel` mm and contoured the
/// same way: the reference of a synthetic tree. `spacing`, `label` and `threshold` do not apply.
ReferenceSurface reference_surface(const Centerline& centerline, double voxel, const ReferenceOptions& options = {});

}  // namespace vmesh

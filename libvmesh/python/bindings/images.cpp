#include <cmath>
#include <variant>

#include <pybind11/stl/filesystem.h>

#include "vmesh/image/image_io.h"
#include "vmesh/reference/reference_surface.h"
#include "vmesh/skeleton/extract_centerline.h"
#include "vmesh/skeleton/vessel_mask.h"

#include "arrays.h"
#include "module.h"
#include "objects.h"
#include "running.h"

namespace vmesh::python {
namespace {

namespace fs = std::filesystem;

/// `values` are indexed [i, j, k]; `affine` takes (i, j, k, 1) to LPS, mm.
LoadedImage image_of(const py::array& values, const py::object& affine) {
  if (values.ndim() != 3 || values.size() == 0) throw InvalidInput("values: an array of three dimensions is needed");
  const char kind = values.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u' && kind != 'b') throw InvalidInput("values: not numbers");
  const py::array_t<double, py::array::c_style | py::array::forcecast> matrix(affine);
  if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4)
    throw InvalidInput("affine: the shape is not (4, 4)");
  // Fortran order, as in VoxelImage: the first axis fastest.
  const py::array_t<float, py::array::f_style | py::array::forcecast> ordered(values);
  LoadedImage loaded;
  loaded.integer = kind != 'f';
  for (py::ssize_t a = 0; a < 3; ++a) {
    loaded.image.size[static_cast<std::size_t>(a)] = static_cast<std::size_t>(ordered.shape(a));
    loaded.image.origin[a] = matrix.at(a, 3);
    for (py::ssize_t b = 0; b < 3; ++b) loaded.image.steps(a, b) = matrix.at(a, b);
  }
  loaded.image.values.assign(ordered.data(), ordered.data() + ordered.size());
  for (const float value : loaded.image.values) {
    if (!std::isfinite(value)) throw InvalidInput("values: not all are finite");
  }
  if (!(std::abs(loaded.image.steps.determinant()) > 0)) throw InvalidInput("affine: its axes span no volume");
  return loaded;
}

SurfacePtr surface_of(const LoadedImage& image, const ReferenceOptions& options) {
  auto surface = std::make_shared<SurfaceObject>();
  surface->warnings = image.warnings;
  surface->result.mesh = reference_surface(image, options).mesh;
  return surface;
}

/// A value, or the name of a segment.
using Label = std::variant<double, std::string>;
/// None, one or several.
using Labels = std::variant<std::monostate, Label, std::vector<Label>>;

void add_label(const Label& label, ReferenceOptions& options) {
  if (const auto* value = std::get_if<double>(&label)) {
    options.labels.push_back(*value);
  } else {
    options.segments.push_back(std::get<std::string>(label));
  }
}

/// Sides of the voxels of an image, of which None tells nothing.
std::optional<Vec3> sides_of(const py::object& voxel_size) {
  if (voxel_size.is_none()) return std::nullopt;
  const Vec3 sides = to_point(voxel_size, "voxel_size");
  if (!(sides.minCoeff() > 0)) throw InvalidInput("voxel_size: sides of voxels are above 0");
  return sides;
}

/// `vessels` is a file, or what has its own.
template <class Vessels>
void check_voxel_size(const Vessels& vessels, const py::object& voxel_size) {
  if (voxel_size.is_none()) return;
  const auto* path = std::get_if<fs::path>(&vessels);
  if (path == nullptr) throw InvalidInput("voxel_size is for files; an array has its affine, a surface no voxels");
  if (!takes_voxel_size(*path))
    throw InvalidInput(path->string() + ": voxel_size does not act on it; the file says how large its voxels are");
}

ReferenceOptions options_of(const Labels& label, std::optional<double> threshold, const py::object& voxel_size,
                            double spacing, double smooth, bool all_components) {
  ReferenceOptions options;
  if (const auto* one = std::get_if<Label>(&label)) add_label(*one, options);
  if (const auto* several = std::get_if<std::vector<Label>>(&label)) {
    for (const Label& each : *several) add_label(each, options);
  }
  options.threshold = threshold;
  options.voxel_size = sides_of(voxel_size);
  options.spacing = spacing;
  options.smooth = smooth;
  options.all_components = all_components;
  return options;
}

}  // namespace

void bind_images(py::module_& module) {
  module.def(
      "reference_surface",
      [](const std::variant<fs::path, py::array>& image, const py::object& affine, const Labels& label,
         std::optional<double> threshold, const py::object& voxel_size, double spacing, double smooth,
         bool all_components) {
        const ReferenceOptions options = options_of(label, threshold, voxel_size, spacing, smooth, all_components);
        check_voxel_size(image, voxel_size);
        const auto* path = std::get_if<fs::path>(&image);
        if (path != nullptr)
          return result_of(py::none(), [&](const Progress&) {
            return surface_of(read_image(*path, read_options_of(options)), options);
          });
        const LoadedImage loaded = image_of(std::get<py::array>(image), affine);
        return result_of(py::none(), [&](const Progress&) { return surface_of(loaded, options); });
      },
      py::arg("image"), py::arg("affine") = py::none(), py::kw_only(), py::arg("label") = py::none(),
      py::arg("threshold") = py::none(), py::arg("voxel_size") = py::none(), py::arg("spacing") = 0.0,
      py::arg("smooth") = 0.0, py::arg("all_components") = true,
      R"(The surface of a segmentation, by marching cubes: what fit() fits to.

    image           a file (.nii, .nii.gz, .nrrd, .mha ...), or an array (ni, nj, nk) indexed [i, j, k]
    affine          (4, 4), of an array: takes (i, j, k, 1) to LPS, mm. NIfTI's is to RAS:
                    numpy.diag([-1, -1, 1, 1]) @ image.affine
    label           voxels of this value, or of one of these, are inside, or those of segments by name, in files of 3D
                    Slicer (.seg.nrrd); without label and threshold, those that are not 0
    threshold       voxels of at least this value are inside
    voxel_size      (3,), sides of a voxel, mm, of a TIFF stack that does not say it
    spacing         side of cubic voxels to resample to, mm; 0: the image's own
    smooth          standard deviation of a Gaussian to smooth with, mm; 0: none
    all_components  False: only the one that encloses the largest volume

Raises ReadError, InvalidInput, Unsupported.)");
  module.def(
      "extract_centerline",
      [](const std::variant<SurfacePtr, fs::path, py::array>& vessels, const py::object& affine, const Labels& label,
         std::optional<double> threshold, const py::object& voxel_size, double spacing, double join, bool largest,
         double least_length, bool tree, bool balanced_wall, const py::object& progress) {
        ExtractOptions options;
        options.spacing = spacing;
        options.join = join;
        options.largest = largest;
        options.least_length = least_length;
        options.tree = tree;
        options.balanced_wall = balanced_wall;
        const auto object_of = [](ExtractedCenterline extracted, std::vector<std::string> warnings = {}) {
          return std::make_shared<CenterlineObject>(CenterlineObject{
              std::move(extracted.centerline), {}, std::move(warnings), {}, std::move(extracted.end_sections)});
        };
        check_voxel_size(vessels, voxel_size);
        if (const auto* surface = std::get_if<SurfacePtr>(&vessels)) {
          if (*surface == nullptr) throw py::type_error("vessels: a Surface, a file or an array is needed, not None");
          if (!std::holds_alternative<std::monostate>(label) || threshold)
            throw InvalidInput("label and threshold are for images, not for a surface");
          return result_of(progress, [&](const Progress& report) {
            return object_of(extract_centerline((*surface)->mesh(), options, report));
          });
        }
        const ReferenceOptions inside = options_of(label, threshold, voxel_size, 0, 0, true);
        if (const auto* path = std::get_if<fs::path>(&vessels))
          return result_of(progress, [&](const Progress& report) {
            std::vector<std::string> warnings;
            ExtractedCenterline extracted =
                extract_centerline(read_vessel_mask(*path, inside, warnings), options, report);
            return object_of(std::move(extracted), std::move(warnings));
          });
        const LoadedImage loaded = image_of(std::get<py::array>(vessels), affine);
        return result_of(progress, [&](const Progress& report) {
          return object_of(extract_centerline(vessel_mask(loaded, inside), options, report));
        });
      },
      py::arg("vessels"), py::arg("affine") = py::none(), py::kw_only(), py::arg("label") = py::none(),
      py::arg("threshold") = py::none(), py::arg("voxel_size") = py::none(),
      py::arg("spacing") = ExtractOptions().spacing, py::arg("join") = ExtractOptions().join,
      py::arg("largest") = false, py::arg("least_length") = 0.0, py::arg("tree") = false,
      py::arg("balanced_wall") = false, py::arg("progress") = py::none(),
      R"(The centerline of a wall or of a segmentation.

    vessels         a Surface, open or closed; or an image, a file or an array (ni, nj, nk) indexed [i, j, k]
    affine          (4, 4), of an array: takes (i, j, k, 1) to LPS, mm
    label           image: voxels of this value, or of one of these, are inside, or those of segments by name, in
                    files of 3D Slicer (.seg.nrrd); without label and threshold, those that are not 0
    threshold       image: voxels of at least this value are inside
    voxel_size      (3,), image: sides of a voxel, mm, of a TIFF stack that does not say it
    spacing         between nodes, in local radii, 0.1 to 10
    join            ends are joined with what they point at over gaps of up to this times the smaller radius
    largest         keep only the longest component
    least_length    leave out components shorter than this, mm; 0: those no longer than wide
    tree            open all loops, each at its neck
    balanced_wall   the Surface's faces, not its vertices, lie on the vessels' boundary in the mean, as in surfaces that
                    vmesh grows
    progress        a function of a stage and a fraction; returning False cancels

Raises ReadError, InvalidInput, Unsupported.)");
}

}  // namespace vmesh::python

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "vmesh/core/progress.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/render/image.h"

namespace vmesh {

/// Where the camera stands, as seen from the mesh (LPS). Azimuth 0 is in front (anterior), 90 at the patient's left;
/// elevation 90 is above (superior).
struct ViewDirection {
  double azimuth_deg = 0;
  double elevation_deg = 0;
};

/// "front", "back", "left", "right", "top", "bottom" or "iso"; also "AZIMUTH,ELEVATION" in degrees ("30,-15").
/// Throws InvalidInput for anything else.
ViewDirection view_direction(std::string_view name);

/// Contents and style of a picture.
struct RenderOptions {
  int width = 1600;   ///< pixels, 16 to 16384
  int height = 1200;  ///< pixels, 16 to 16384

  ViewDirection view;
  /// The point at the centre of the picture; by default the centre of the mesh.
  std::optional<Vec3> look_at;
  /// Height of the scene shown at look_at, mm; 0: enough for the whole mesh with a margin.
  double view_height_mm = 0;
  /// Magnification on top of that, > 0.
  double zoom = 1;
  /// Vertical field of view, degrees, below 120; 0 is an orthographic picture.
  double field_of_view_deg = 0;

  bool edges = false;                ///< draw the triangles' edges
  double edge_width_px = 1.4;        ///< > 0
  bool smooth = true;                ///< shade with interpolated normals, else facet by facet
  bool highlight_back_faces = true;  ///< the inside of the surface in magenta, so that inverted faces and holes show
  double occlusion = 0.7;            ///< darkening where little ambient light arrives, 0 to 1
  bool legend = true;                ///< draw the legend of an attribute
  Color material = {204, 44, 36};    ///< colour without an attribute
  Color background = {246, 247, 249};

  /// Attribute values at the ends of the colour scale; by default the smallest and the largest value.
  std::optional<std::pair<double, double>> range;
  /// The values are labels without an order: each has a colour of its own, distinct from those of neighbouring numbers.
  /// Labels of vertices are not interpolated, and `range` is ignored. Colours repeat after many labels.
  bool categories = false;
};

/// The colour of a label (rounded to an integer) in a picture of categories.
Color label_color(double label);

/// Draws a mesh without a display, by casting rays on the threads of the caller's arena (oneTBB). The same input gives
/// the same picture, whatever the threads. A legend has the right side of the picture to itself.
/// Throws InvalidInput for a mesh without faces, with faces that name vertices which do not exist, with positions that
/// are not finite, and for options out of range; Cancelled.
Image render(const TriMesh& mesh, const RenderOptions& options = {}, const Progress& progress = {});

/// Whether an attribute has one value per vertex or per face.
enum class AttributeDomain { vertex, face };

/// The same, coloured by an attribute, from dark blue (low) to yellow (high) or by category, with a legend. NaN is
/// drawn grey. Throws InvalidInput also when there is not one value per vertex or face, or when none is finite and no
/// range is given.
Image render(const TriMesh& mesh, const MeshAttribute& attribute, AttributeDomain domain,
             const RenderOptions& options = {}, const Progress& progress = {});

/// The same by the attribute of that name, or by "skewness", which is measured. Integer attributes (segment, branch,
/// ModelFaceID ...) are categories, unless a range is given. Throws InvalidInput also for a name that there is not,
/// listing those there are.
Image render(const TriMesh& mesh, const MeshAttributes& attributes, const std::string& color,
             const RenderOptions& options = {}, const Progress& progress = {});

}  // namespace vmesh

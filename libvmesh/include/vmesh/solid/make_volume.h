// From a surface around vessels to a volume mesh for solvers: layers of wedges along the wall, tetrahedra within, and
// shells of wedges for the wall's own thickness.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmesh/core/progress.h"
#include "vmesh/core/stage_time.h"
#include "vmesh/mesh/volume_mesh.h"
#include "vmesh/solid/vessel_wall.h"
#include "vmesh/solid/volume_check.h"

namespace vmesh {

/// Layers along the wall. None with count 0.
struct LayerOptions {
  int count = 0;
  double thickness = 0.2;  ///< of all layers together, in local radii, or with `in_mm` in mm
  bool in_mm = false;
  double first_mm = 0;  ///< if positive, the thickness follows from that of the layer at the wall, whatever `thickness`
  double growth = 1;    ///< thickness of a layer by that of the one nearer to the wall
  bool merged = false;  ///< outside: where layers meet, what is between them is filled, so that walls are one
};

struct VolumeOptions {
  LayerOptions layers = {.count = 4, .growth = 1.2};  ///< inside, of the lumen
  LayerOptions shell = {.count = 0};                  ///< outside: the vessel's own wall
  bool shell_only = false;                            ///< no mesh of the lumen
  /// Length of edges in the core, in local radii; 0: as those of the surface.
  double core_size = 0;
};

/// Largest LayerOptions::count.
inline constexpr int kMostLayers = 100;

/// What keeps layers from being as thick as they should be.
enum class LayerLimit {
  none,
  gradation,  ///< layers nearby are thinner
  shape,      ///< cells would turn over or become flat
  room        ///< the layers of another place are in the way
};
std::string_view to_string(LayerLimit limit);

/// Connected vertices of the wall at which layers end, or have less than kFullLayers of the thickness that was asked
/// for.
struct ThinPlace {
  Vec3 position = Vec3::Zero();         ///< where they are thinnest, mm
  double asked_mm = 0, reached_mm = 0;  ///< 0: they end there
  std::size_t vertices = 0;
  LayerLimit limit = LayerLimit::none;  ///< where they are thinnest
};

/// Share of the thickness that was asked for from which on layers count as complete.
inline constexpr double kFullLayers = 0.9;

/// How thick layers became. They end where they do not fit at all, in pyramids and tetrahedra between those of wedges.
/// Thickness is measured along the way of a vertex, in the mean of the heights over its faces.
struct LayerSummary {
  double full_share = 1;        ///< of the wall's area, with kFullLayers of the thickness that was asked for
  double least_share = 1;       ///< of it anywhere
  std::vector<ThinPlace> thin;  ///< thinnest first, by share
};

/// How layers became, in a sentence each: the share of the wall where they are complete, and the thinnest places.
/// `what`: of which layers.
std::vector<std::string> sentences_of(const LayerSummary& summary, const std::string& what);

/// Tetrahedra between the layers of walls that meet.
struct MergedPlace {
  Vec3 position = Vec3::Zero();  ///< their centre, mm
  double volume_mm3 = 0;
  std::size_t tetrahedra = 0;
};

/// A volume mesh. The vertices of the wall come first among its points, in their order in the surface. It is sound, or
/// `defects` tell why not.
struct VolumeResult {
  VolumeMesh mesh;
  LayerSummary layers, shell;
  std::vector<MergedPlace> merged;  ///< with LayerOptions::merged; largest first
  std::vector<VolumeDefect> defects;
  std::vector<StageTime> stages;

  bool is_sound() const { return defects.empty(); }
};

/// Whether this build has the library (TetGen) that a lumen needs; a shell alone does without.
bool can_mesh_lumen();

/// Layers end on the planes of caps: there, caps are triangulated anew, with the traces of layers as rings of
/// quadrilaterals. Regions are "lumen" and "wall"; patches those of the surface, and "cap_k_wall" for the ends of the
/// shell, "lumen_wall" for its inside where the lumen is not meshed. Deterministic. To be called from one thread at a
/// time, as TetGen has state. Throws InvalidInput for options out of range, for a surface that is not closed, manifold
/// and outward, that crosses itself or whose caps are not flat discs; Unsupported where can_mesh_lumen() is false
/// and a lumen is to be meshed or walls merged;
/// Cancelled when `progress` asks to stop, which it is not asked while TetGen works.
VolumeResult make_volume(const VesselWall& wall, const VolumeOptions& options = {}, const Progress& progress = {});

}  // namespace vmesh

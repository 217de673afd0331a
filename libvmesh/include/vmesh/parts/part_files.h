#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vmesh/centerline/simplification.h"
#include "vmesh/surface/part.h"

namespace vmesh {

/// What the cones of a part correspond to in the centerline that was read, before simplification and separation:
/// parameter t of a cone is one of a stretch; a piece of that covers a stretch of an original segment.
struct ConeOrigins {
  struct Stretch {
    double t_first = 0, t_last = 1;

    double at(double t) const { return t_first + t * (t_last - t_first); }
  };

  std::vector<Stretch> stretch;                     ///< of cones
  std::vector<Index> offsets;                       ///< of cones, in `pieces`; one more for the end
  std::vector<SimplifiedCenterline::Piece> pieces;  ///< one for an isolated node
  std::vector<Stretch> within;                      ///< of pieces
  std::vector<Index> branch;                        ///< of cones: the label of their branch (label_branches())
  std::vector<Index> node;                          ///< of nodes; kNone for those that separating added

  SimplifiedCenterline::Place original(Index cone, double t) const;
  /// Converts nodes and segments of the note from the part's numbers to those of the centerline that was read.
  void refer_to_original(GrowthSimplification& note) const;
};

/// The input of surfaces in parts, as in SurfaceMetadata.
struct PartsSource {
  std::string generator, options, input_name, input_sha256;

  bool operator==(const PartsSource&) const = default;
};

/// What all parts of a surface have in common; stored in parts.json beside them.
struct PartsManifest {
  std::string id;  ///< of this splitting: parts with another id do not belong to it
  PartsSource source;
  std::size_t parts = 0, pieces = 0, seams = 0;
  Index around = 0;
  std::size_t components = 0, cycle_rank = 0;  ///< of the centerline
  double expected_vertices = 0;
  std::vector<GrowthSimplification> simplifications;  ///< branches that were left out; numbers as they were read
};

/// Name of a part's file without extension: "part_00001"; `number` counts from 0.
std::string part_name(std::size_t number);
inline constexpr const char* kPartExtension = ".vpart";
inline constexpr const char* kPartSurfaceExtension = ".vsurf";
inline constexpr const char* kManifestName = "parts.json";

/// Files appear complete or not at all; the same contents give the same bytes. These functions throw WriteError.
void write_manifest(const std::filesystem::path& path, const PartsManifest& manifest);

struct StoredPart {
  std::string id;  ///< of the splitting
  SurfacePart part;
  ConeOrigins origins;
};
void write_part(const std::filesystem::path& path, const StoredPart& part);

/// A part's sound surface, and where its vertices belong on the centerline that was read.
struct StoredPartSurface {
  std::string id;
  PartSurface surface;
  std::vector<SimplifiedCenterline::Place> place;  ///< of vertices: segment and parameter
  std::vector<Index> branch;                       ///< of vertices: label
};
void write_part_surface(const std::filesystem::path& path, const StoredPartSurface& surface);

/// These functions throw ReadError and InvalidInput naming the file; a checksum detects damage. `verify`: whether to
/// check it.
PartsManifest read_manifest(const std::filesystem::path& path);
StoredPart read_part(const std::filesystem::path& path);
StoredPartSurface read_part_surface(const std::filesystem::path& path, bool verify = true);

/// The surface with bindings to the centerline that was read.
StoredPartSurface refer_to_read(const StoredPart& part, PartSurface surface);

}  // namespace vmesh

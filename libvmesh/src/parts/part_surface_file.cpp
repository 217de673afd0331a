#include <algorithm>

#include "vmesh/parts/part_files.h"

#include "parts/columns.h"
#include "parts/headers.h"

namespace vmesh {
namespace {

using nlohmann::json;

constexpr const char* kPartSurfaceSchema = "vmesh.part-surface/2";

// All but the header.
void describe(auto& columns, auto& stored) {
  auto& surface = stored.surface;
  const auto segment = [](auto& place) { return std::tie(place.segment); };
  const auto parameter = [](auto& place) { return std::tie(place.t); };
  columns.column("seams", surface.seams);
  columns.rows("pieces", surface.pieces, [](auto& p) {
    return std::tie(p.vertex_count, p.face_count, p.junctions, p.tubes, p.filled_loops, p.rung);
  });
  columns.rows("pieces.refused", surface.pieces,
               [](auto& p) { return std::tie(p.refused.degenerate, p.refused.axis, p.refused.crossing); });
  columns.rows("pieces.worst_skewness", surface.pieces, [](auto& piece) { return std::tie(piece.worst_skewness); });
  columns.rows("crossings", surface.crossings, kBoth);
  columns.column("vertices", surface.mesh.vertices);
  columns.rows("faces", surface.mesh.faces, [](auto& face) { return std::tie(face[0], face[1], face[2]); });
  columns.column("radius", surface.radius);
  columns.rows("cone", surface.binding, segment);
  columns.rows("t", surface.binding, parameter);
  columns.rows("segment", stored.place, segment);
  columns.rows("parameter", stored.place, parameter);
  columns.column("branch", stored.branch);
}

}  // namespace

void write_part_surface(const std::filesystem::path& path, const StoredPartSurface& stored) {
  const PartSurface& surface = stored.surface;
  json notes = json::array();
  for (const PartSurface::Piece& piece : surface.pieces) {
    if (!piece.faults.empty()) throw InvalidInput(path.string() + ": a part that is not sound is not written");
  }
  for (const GrowthSimplification& note : surface.simplifications) notes.push_back(to_json(note));
  ArrayWriter file({{"schema", kPartSurfaceSchema},
                    {"id", stored.id},
                    {"first_piece", surface.first_piece},
                    {"around", surface.around},
                    {"simplifications", notes}});
  ColumnWriter columns(file);
  describe(columns, stored);
  file.write(path);
}

StoredPartSurface read_part_surface(const std::filesystem::path& path, bool verify) {
  ArrayFile file(path, kPartSurfaceSchema);
  if (verify) file.verify();
  StoredPartSurface stored;
  PartSurface& surface = stored.surface;
  ColumnReader columns(file);
  describe(columns, stored);
  const std::size_t pieces = file.count("pieces.worst_skewness");
  file.require(file.count("pieces") == 6 * pieces && file.count("pieces.refused") == 3 * pieces,
               "is damaged: its pieces are inconsistent");
  for (const PartSurface::Piece& piece : surface.pieces)
    file.require(piece.rung < kRungs, "is damaged: a piece was found on a rung that there is not");
  read_header(file, [&](const json& header) {
    stored.id = header.at("id").get<std::string>();
    surface.first_piece = header.at("first_piece").get<Index>();
    surface.around = around_of(header.at("around"));
    for (const json& note : header.at("simplifications")) surface.simplifications.push_back(note_of(note));
  });
  const std::size_t count = surface.mesh.vertices.size();
  std::size_t own = surface.seams.size() * std::size_t{surface.around}, face_count = 0;
  for (const PartSurface::Piece& piece : surface.pieces) {
    own += piece.vertex_count;
    face_count += piece.face_count;
  }
  const auto are_vertices = [&](const Triangle& face) { return std::ranges::max(face) < count; };
  const auto is_face = [&](const auto& pair) { return pair.first < pair.second && pair.second < face_count; };
  const auto is_of_vertices = [&](const char* array) { return file.count(array) == count; };
  const auto of_vertices = {"radius", "cone", "t", "segment", "parameter", "branch"};
  file.require(
      own == count && face_count == surface.mesh.faces.size() && std::ranges::all_of(of_vertices, is_of_vertices) &&
          std::ranges::all_of(surface.mesh.faces, are_vertices) && std::ranges::all_of(surface.crossings, is_face),
      "is damaged: vertices, faces and pieces are inconsistent");
  return stored;
}

}  // namespace vmesh

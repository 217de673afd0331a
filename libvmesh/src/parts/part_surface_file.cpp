#include <algorithm>

#include "vmesh/parts/part_files.h"

#include "parts/headers.h"

namespace vmesh {
namespace {

using nlohmann::json;

constexpr const char* kSchema = "vmesh.part-surface/1";

// Places on the centerline in columns.
struct PlaceColumns {
  std::vector<Index> segment;
  std::vector<double> t;

  void add(Index s, double u) {
    segment.push_back(s);
    t.push_back(u);
  }
};

}  // namespace

void write_part_surface(const std::filesystem::path& path, const StoredPartSurface& stored) {
  const PartSurface& surface = stored.surface;
  json notes = json::array();
  std::vector<Index> pieces;
  std::vector<double> worst;
  for (const PartSurface::Piece& piece : surface.pieces) {
    pieces.insert(pieces.end(),
                  {piece.vertex_count, piece.face_count, piece.junctions, piece.tubes, piece.filled_loops, piece.rung});
    worst.push_back(piece.worst_skewness);
    if (!piece.faults.empty()) throw InvalidInput(path.string() + ": a part that is not sound is not written");
  }
  for (const GrowthSimplification& note : surface.simplifications) notes.push_back(to_json(note));
  ArrayWriter file({{"schema", kSchema},
                    {"id", stored.id},
                    {"first_piece", surface.first_piece},
                    {"around", surface.around},
                    {"simplifications", notes}});
  PlaceColumns binding, place;
  for (const CenterlineBinding& b : surface.binding) binding.add(b.segment, b.t);
  for (const SimplifiedCenterline::Place& p : stored.place) place.add(p.segment, p.t);
  std::vector<Index> faces, crossings;
  for (const Triangle& f : surface.mesh.faces) faces.insert(faces.end(), f.begin(), f.end());
  for (const auto& [f, g] : surface.crossings) crossings.insert(crossings.end(), {f, g});
  file.add("seams", surface.seams);
  file.add("pieces", pieces);
  file.add("pieces.worst_skewness", worst);
  file.add("crossings", crossings);
  file.add("vertices", surface.mesh.vertices);
  file.add("faces", faces);
  file.add("radius", surface.radius);
  file.add("cone", binding.segment);
  file.add("t", binding.t);
  file.add("segment", place.segment);
  file.add("parameter", place.t);
  file.add("branch", stored.branch);
  file.write(path);
}

StoredPartSurface read_part_surface(const std::filesystem::path& path, bool verify) {
  ArrayFile file(path, kSchema);
  if (verify) file.verify();
  StoredPartSurface stored;
  PartSurface& surface = stored.surface;
  std::vector<Index> pieces, faces, crossings;
  std::vector<double> worst;
  file.read("pieces", pieces);
  file.read("pieces.worst_skewness", worst);
  file.require(pieces.size() == 6 * worst.size(), "is damaged: its pieces are inconsistent");
  for (std::size_t p = 0; p < worst.size(); ++p) {
    const Index* n = pieces.data() + 6 * p;
    file.require(n[5] < kRungs, "is damaged: a piece was found on a rung that there is not");
    surface.pieces.push_back({n[0], n[1], n[2], n[3], n[4], n[5], worst[p], {}});
  }
  read_header(file, [&](const json& header) {
    stored.id = header.at("id").get<std::string>();
    surface.first_piece = header.at("first_piece").get<Index>();
    surface.around = around_of(header.at("around"));
    for (const json& note : header.at("simplifications")) surface.simplifications.push_back(note_of(note));
  });
  file.read("seams", surface.seams);
  file.read("vertices", surface.mesh.vertices);
  file.read("faces", faces);
  for (std::size_t i = 0; i + 2 < faces.size(); i += 3)
    surface.mesh.faces.push_back({faces[i], faces[i + 1], faces[i + 2]});
  file.read("crossings", crossings);
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    surface.crossings.emplace_back(crossings[i], crossings[i + 1]);
  file.read("radius", surface.radius);
  PlaceColumns binding, place;
  file.read("cone", binding.segment);
  file.read("t", binding.t);
  file.read("segment", place.segment);
  file.read("parameter", place.t);
  file.read("branch", stored.branch);
  const std::size_t count = surface.mesh.vertices.size();
  std::size_t own = surface.seams.size() * std::size_t{surface.around}, face_count = 0;
  for (const PartSurface::Piece& piece : surface.pieces) {
    own += piece.vertex_count;
    face_count += piece.face_count;
  }
  const auto is_vertex = [&](Index v) { return v < count; };
  const auto is_face = [&](const auto& pair) { return pair.first < pair.second && pair.second < face_count; };
  file.require(own == count && face_count == surface.mesh.faces.size() && surface.radius.size() == count &&
                   binding.segment.size() == count && binding.t.size() == count && place.segment.size() == count &&
                   place.t.size() == count && stored.branch.size() == count &&
                   std::all_of(faces.begin(), faces.end(), is_vertex) &&
                   std::all_of(surface.crossings.begin(), surface.crossings.end(), is_face),
               "is damaged: vertices, faces and pieces are inconsistent");
  for (std::size_t v = 0; v < count; ++v) {
    surface.binding.push_back({binding.segment[v], binding.t[v]});
    stored.place.push_back({place.segment[v], place.t[v]});
  }
  return stored;
}

}  // namespace vmesh

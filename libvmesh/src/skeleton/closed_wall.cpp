#include "closed_wall.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"
#include "vmesh/mesh/check_indices.h"
#include "vmesh/mesh/topology.h"

#include "flat_caps.h"
#include "nested_shells.h"
#include "openings.h"
#include "wall_cleaning.h"
#include "wall_shells.h"
#include "wall_text.h"
#include "wrapped_wall.h"

namespace vmesh::skeleton {
namespace {

constexpr double kBytesPerFace = 1000;  // measured, without wrapping
// A piece that is closed bounds no volume by itself if its mean half thickness, twice the volume by the area, is less
// than this share of its largest opening's size; or than the second if the piece is little more than the rim of that
// opening: of several such dishes, each is one of a wall's many faces.
constexpr double kSheet = 0.02, kDish = 0.25, kMostlyOpen = 0.6;
constexpr std::size_t kManyPieces = 10;
// Sheets of less than this share of the area are left out.
constexpr double kFewSheets = 0.05;

void check(const TriMesh& surface) {
  if (surface.faces.empty()) throw InvalidInput("the surface has no face; give a surface of triangles or polygons");
  check_indices(surface);
  for (const Triangle& face : surface.faces) {
    for (const Index v : face) {
      if (!surface.vertices[v].allFinite())
        throw InvalidInput("vertex " + std::to_string(v) +
                           " of the surface has a position that is no number; write the surface anew");
    }
  }
  const double area = area_of(surface);
  if (!(area > 0)) throw InvalidInput("no face of the surface has an area; give the surface or image it was made from");
  if (!std::isfinite(area)) throw InvalidInput("positions of the surface are too large; give it in another unit");
  require_memory(kBytesPerFace * static_cast<double>(surface.faces.size()),
                 "closing a surface of " + std::to_string(surface.faces.size()) + " faces", "make the surface coarser");
}

/// Whether a piece bounds no volume by itself.
bool is_sheet(const Shell& shell, bool among_many) {
  if (shell.largest_opening == 0) return false;
  double wall = 0, filling = 0;
  const TriMesh& mesh = shell.part.mesh;
  for (Index f = 0; f < mesh.faces.size(); ++f)
    (shell.part.is_filling[f] ? filling : wall) += 0.5 * area_normal(mesh, f).norm();
  const double thickness = 2 * shell.part.volume / (wall + filling), opening = std::sqrt(shell.largest_opening);
  if (thickness < kSheet * opening) return true;
  return among_many && shell.largest_opening > kMostlyOpen * wall && thickness < kDish * opening;
}

bool is_sound(const TriMesh& mesh) {
  const Topology topology = measure_topology(mesh);
  return topology.closed && topology.manifold && topology.oriented;
}

void append(Shell& soup, Shell piece) {
  TriMesh& mesh = soup.part.mesh;
  const auto vertices = static_cast<Index>(mesh.vertices.size()), ends = static_cast<Index>(soup.ends.size());
  mesh.vertices.insert(mesh.vertices.end(), piece.part.mesh.vertices.begin(), piece.part.mesh.vertices.end());
  for (const auto& [a, b, c] : piece.part.mesh.faces) mesh.faces.push_back({a + vertices, b + vertices, c + vertices});
  for (const Index end : piece.part.end_of_face) soup.part.end_of_face.push_back(end == kNone ? kNone : end + ends);
  soup.part.is_filling.insert(soup.part.is_filling.end(), piece.part.is_filling.begin(), piece.part.is_filling.end());
  std::move(piece.ends.begin(), piece.ends.end(), std::back_inserter(soup.ends));
}

/// The surface without what closes it and without ends.
Shell opened(const Shell& shell) {
  Shell open;
  open.part.mesh.vertices = shell.part.mesh.vertices;
  for (Index f = 0; f < shell.part.mesh.faces.size(); ++f) {
    if (!shell.part.is_filling[f]) open.part.mesh.faces.push_back(shell.part.mesh.faces[f]);
  }
  open.part.end_of_face.assign(open.part.mesh.faces.size(), kNone);
  open.part.is_filling.assign(open.part.mesh.faces.size(), false);
  return open;
}

/// What is closed is sorted into shells and what is to be wrapped.
struct Pieces {
  std::vector<Shell> shells;
  Shell soup;
};

Pieces closed_pieces(WallShells&& found, ClosedWall& wall) {
  Pieces pieces;
  OpeningsClosed closed;
  std::vector<Shell> sheets;
  double area = 0, sheet_area = 0;
  for (TriMesh& mesh : found.sound) {
    area += area_of(mesh);
    OpeningsClosed with_this = closed;
    Shell shell = closed_shell(mesh, with_this);
    if (is_sheet(shell, found.sound.size() >= kManyPieces)) {
      sheet_area += area_of(mesh);
      sheets.push_back(opened(shell));
    } else if (!is_sound(shell.part.mesh)) {
      found.unsound.push_back(std::move(mesh));
    } else {
      pieces.shells.push_back(std::move(shell));
      closed = with_this;
    }
  }
  for (TriMesh& mesh : found.unsound) {
    area += area_of(mesh);
    append(pieces.soup, closed_soup(std::move(mesh), closed));
  }
  if (sheet_area > kFewSheets * area) {
    for (Shell& sheet : sheets) append(pieces.soup, std::move(sheet));
  } else if (!sheets.empty()) {
    wall.notes.push_back(
        counted(sheets.size(), "sheet that bounds no volume is left out", "sheets that bound no volume are left out"));
  }
  for (std::string& note : closed.notes()) wall.notes.push_back(std::move(note));
  return pieces;
}

void wrap_soup(Pieces& pieces, ClosedWall& wall, const Progress& progress) {
  if (pieces.soup.part.mesh.faces.empty()) return;
  WrappedWall wrap = wrapped(pieces.soup, progress);
  wall.notes.push_back(std::move(wrap.note));
  wall.wrap_offset = wrap.offset;
  std::move(wrap.shells.begin(), wrap.shells.end(), std::back_inserter(pieces.shells));
}

void note_turned(const std::vector<Shell>& shells, std::vector<std::string>& notes) {
  const auto inward = static_cast<std::size_t>(
      std::count_if(shells.begin(), shells.end(), [](const Shell& s) { return s.was_inward; }));
  if (inward == 0) return;
  notes.push_back(shells.size() == 1 ? "the surface faced inwards and is turned"
                                     : counted(inward, "component faced inwards and is turned",
                                               "components faced inwards and are turned"));
}

void assemble(std::vector<Shell>&& shells, ClosedWall& wall) {
  for (Shell& shell : shells) {
    const auto first = static_cast<Index>(wall.ends.size());
    for (FlatWallEnd& end : shell.ends) {
      end.part = wall.parts.size();
      wall.ends.push_back(std::move(end));
    }
    for (Index& end : shell.part.end_of_face) end = end == kNone ? kNone : end + first;
    wall.parts.push_back(std::move(shell.part));
  }
}

}  // namespace

ClosedWall close_wall(const TriMesh& surface, const Progress& progress) {
  check(surface);
  ClosedWall wall;
  report_progress(progress, "closing the wall", 0);
  WallShells found = shells_of(surface);
  wall.notes = std::move(found.notes);
  report_progress(progress, "closing the wall", 0.3);
  Pieces pieces = closed_pieces(std::move(found), wall);
  report_progress(progress, "closing the wall", 0.6);
  wrap_soup(pieces, wall, progress);
  keep_lumens(pieces.shells, wall.notes);
  if (pieces.shells.empty())
    throw InvalidInput("the surface encloses no volume; give one that does, or the image it was made from");
  note_turned(pieces.shells, wall.notes);
  std::size_t caps = 0;
  for (Shell& shell : pieces.shells) {
    report_progress(progress, "closing the wall", 0.8);
    find_flat_caps(shell, caps);
  }
  if (caps > 0)
    wall.notes.push_back(
        counted(caps, "flat cap is taken for an end of a vessel", "flat caps are taken for ends of vessels"));
  assemble(std::move(pieces.shells), wall);
  report_progress(progress, "closing the wall", 1);
  return wall;
}

}  // namespace vmesh::skeleton

// SimVascular's models: MODEL.mdl names the faces of MODEL.vtp, as MODEL.vtp.facenames did before (SimVascular,
// sv4gui_ModelIO.cxx and sv4gui_ModelLegacyIO.cxx).
#include <cmath>
#include <map>
#include <ostream>
#include <set>

#include "vmesh/core/error.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/patch_names.h"

#include "boundaries.h"
#include "formats.h"

namespace vmesh::io {
namespace {

constexpr const char* kFaceNumber = "ModelFaceID";

struct ModelFace {
  Index number;  ///< ModelFaceID
  std::string name;
  bool is_wall;
};

/// With numbers of faces by boundaries_of(), where the surface has none.
MeshAttributes with_numbers(const TriMesh& mesh, const MeshAttributes& given) {
  MeshAttributes attributes = given;
  if (find_attribute(given.face, kFaceNumber) != nullptr) return attributes;
  MeshAttribute numbers{kFaceNumber, std::vector<double>(mesh.faces.size(), 1), true};
  const std::vector<Boundary> boundaries = boundaries_of(mesh, given);
  for (std::size_t b = 0; b < boundaries.size(); ++b) {
    for (const Index f : boundaries[b].faces) numbers.values[f] = static_cast<double>(b + 1);
  }
  attributes.face.push_back(std::move(numbers));
  return attributes;
}

Index checked_number(double number, std::size_t face) {
  constexpr double kMost = 1e9;
  if (!(number >= 1 && number <= kMost && number == std::floor(number)))
    throw InvalidInput("face " + std::to_string(face) +
                       ": its ModelFaceID is no whole number above 0, as SimVascular needs it; number faces from 1");
  return static_cast<Index>(number);
}

/// One for every number, ascending. Those that have a boundary's name in common get their numbers behind it.
std::vector<ModelFace> model_faces(const TriMesh& mesh, const MeshAttributes& given) {
  const std::vector<double> numbers = find_attribute(with_numbers(mesh, given).face, kFaceNumber)->values;
  const std::vector<Boundary> boundaries = boundaries_of(mesh, given);
  const bool has_patches = find_attribute(given.face, kFaceNumber) != nullptr || boundaries.size() > 1;
  std::map<Index, ModelFace> faces;
  for (const Boundary& boundary : boundaries) {
    std::set<Index> of_boundary;
    for (const Index f : boundary.faces) of_boundary.insert(checked_number(numbers[f], f));
    for (const Index number : of_boundary) {
      ModelFace face{number, has_patches ? boundary.name : "wall", false};
      face.is_wall = face.name == "wall" || is_wall_patch(number, given.patch_names);
      if (of_boundary.size() > 1) face.name += "_" + std::to_string(number);
      faces.emplace(number, face);
    }
  }
  std::vector<ModelFace> list;
  for (const auto& [number, face] : faces) list.push_back(face);
  return list;
}

}  // namespace

void write_model(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes, const SurfaceMetadata&,
                 const SurfaceWriteOptions&) {
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<model type=\"PolyData\" version=\"1.0\">\n"
         "    <timestep id=\"0\">\n        <model_element type=\"PolyData\" num_sampling=\"0\" use_uniform=\"0\">\n"
         "            <segmentations />\n            <faces>\n";
  // Names are letters, digits, '_', '-' and '.' only, or those of boundaries_of().
  for (const ModelFace& face : model_faces(mesh, attributes))
    out << "                <face id=\"" << face.number << "\" name=\"" << face.name << "\" type=\""
        << (face.is_wall ? "wall" : "cap")
        << "\" visible=\"true\" opacity=\"1\" color1=\"1\" color2=\"1\" color3=\"1\" />\n";
  out << "            </faces>\n            <blend_radii />\n        </model_element>\n    </timestep>\n</model>\n";
}

void write_model_surface(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
                         const SurfaceMetadata& metadata, const SurfaceWriteOptions& options) {
  write_surface_vtp(out, mesh, with_numbers(mesh, attributes), metadata, options);
}

void write_face_names(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes, const SurfaceMetadata&,
                      const SurfaceWriteOptions&) {
  out << "global gPolyDataFaceNames\n";
  for (const ModelFace& face : model_faces(mesh, attributes))
    out << "set gPolyDataFaceNames(" << face.number << ") {" << face.name << "}\n";
}

}  // namespace vmesh::io

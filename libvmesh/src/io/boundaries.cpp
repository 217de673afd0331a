#include "boundaries.h"

#include <map>
#include <numeric>

#include "vmesh/mesh/find_attribute.h"

#include "text.h"

namespace vmesh::io {
namespace {

constexpr double kWall = -1;  ///< as CapID

std::string numbered(const char* word, double number) {
  std::string name = word;
  append(name, number);
  return name;
}

std::vector<Index> all_faces(const TriMesh& mesh) {
  std::vector<Index> faces(mesh.faces.size());
  std::iota(faces.begin(), faces.end(), Index{0});
  return faces;
}

std::vector<Boundary> named_boundaries(const std::vector<std::string>& names, const MeshAttribute& labels) {
  std::vector<Boundary> boundaries;
  for (const std::string& name : names) boundaries.push_back({name, {}});
  for (Index f = 0; f < labels.values.size(); ++f)
    boundaries.at(static_cast<std::size_t>(labels.values[f]) - 1).faces.push_back(f);
  std::erase_if(boundaries, [](const Boundary& boundary) { return boundary.faces.empty(); });
  return boundaries;
}

std::map<double, std::vector<Index>> faces_by(const MeshAttribute& labels) {
  std::map<double, std::vector<Index>> faces;
  for (Index f = 0; f < labels.values.size(); ++f) {
    const double label = labels.values[f];
    faces[label > 0 ? label : kWall].push_back(f);  // also what is not a number
  }
  return faces;
}

}  // namespace

std::vector<Boundary> boundaries_of(const TriMesh& mesh, const MeshAttributes& attributes) {
  const MeshAttribute* caps = find_attribute(attributes.face, "CapID");
  const MeshAttribute* numbers = find_attribute(attributes.face, "ModelFaceID");
  if (numbers != nullptr && !attributes.patch_names.empty()) return named_boundaries(attributes.patch_names, *numbers);
  const MeshAttribute* labels = caps != nullptr ? caps : numbers;
  if (labels == nullptr || mesh.faces.empty()) return {{"surface", all_faces(mesh)}};
  const char* word = caps != nullptr ? "cap_" : "face_";
  std::vector<Boundary> boundaries;
  for (auto& [label, faces] : faces_by(*labels))
    boundaries.push_back({label == kWall ? "wall" : numbered(word, label), std::move(faces)});
  return boundaries;
}

}  // namespace vmesh::io

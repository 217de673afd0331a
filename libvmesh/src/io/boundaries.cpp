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
  const MeshAttribute* labels = caps != nullptr ? caps : find_attribute(attributes.face, "ModelFaceID");
  if (labels == nullptr || mesh.faces.empty()) return {{"surface", all_faces(mesh)}};
  const char* word = caps != nullptr ? "cap_" : "face_";
  std::vector<Boundary> boundaries;
  for (auto& [label, faces] : faces_by(*labels))
    boundaries.push_back({label == kWall ? "wall" : numbered(word, label), std::move(faces)});
  return boundaries;
}

}  // namespace vmesh::io

#include "boundaries.h"

#include <map>
#include <numeric>

#include "vmesh/mesh/find_attribute.h"

#include "text.h"

namespace vmesh::io {
namespace {

constexpr double kWall = -1;  ///< as CapID

std::string name_of_cap(double id) {
  if (id == kWall) return "wall";
  std::string name = "cap_";
  append(name, id);
  return name;
}

std::vector<Index> all_faces(const TriMesh& mesh) {
  std::vector<Index> faces(mesh.faces.size());
  std::iota(faces.begin(), faces.end(), Index{0});
  return faces;
}

}  // namespace

std::vector<Boundary> boundaries_of(const TriMesh& mesh, const MeshAttributes& attributes) {
  const MeshAttribute* caps = find_attribute(attributes.face, "CapID");
  if (caps == nullptr || mesh.faces.empty()) return {{"surface", all_faces(mesh)}};
  std::map<double, std::vector<Index>> faces;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const double id = caps->values[f];
    faces[id > 0 ? id : kWall].push_back(f);  // also what is not a number
  }
  std::vector<Boundary> boundaries;
  for (auto& [id, of_id] : faces) boundaries.push_back({name_of_cap(id), std::move(of_id)});
  return boundaries;
}

}  // namespace vmesh::io

#include "vmesh/surface/surface_attributes.h"

#include <algorithm>
#include <map>

#include "vmesh/core/error.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/branch_labels.h"

namespace vmesh {
namespace {

MeshAttribute branch_attribute(const std::vector<Index>& labels) {
  return {"branch", {labels.begin(), labels.end()}, true};
}

MeshAttribute opening_labels(const TriMesh& mesh, const std::vector<Opening>& openings) {
  MeshAttribute labels{"opening", std::vector<double>(mesh.vertices.size(), 0), true};
  for (std::size_t i = 0; i < openings.size(); ++i) {
    for (const Index v : openings[i].ring) labels.values[v] = static_cast<double>(i + 1);
  }
  return labels;
}

}  // namespace

MeshAttributes surface_attributes(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                                  const std::vector<double>& radius, const std::vector<Opening>& openings,
                                  const Centerline& centerline) {
  MeshAttributes attributes;
  const BranchLabels branch = label_branches(mesh, binding, centerline);
  MeshAttribute segment{"segment", {}, true}, parameter{"parameter", {}};
  for (const CenterlineBinding& place : binding) {
    segment.values.push_back(place.segment);
    parameter.values.push_back(place.t);
  }
  attributes.vertex.push_back({"radius", radius});
  attributes.vertex.push_back(std::move(segment));
  attributes.vertex.push_back(std::move(parameter));
  attributes.vertex.push_back(branch_attribute(branch.vertex));
  if (!openings.empty()) attributes.vertex.push_back(opening_labels(mesh, openings));
  attributes.face.push_back({"EquiangleSkewness", equiangle_skewness(mesh)});
  attributes.face.push_back(branch_attribute(branch.face));
  return attributes;
}

std::string name_of_end(const FlatEnd& end, const std::vector<EndName>& names) {
  for (const EndName& given : names) {
    if (given.node == end.node) return given.name;
  }
  return "cap_" + std::to_string(end.label);
}

void add_cap_labels(const FlatEnds& ends, MeshAttributes& attributes, const std::vector<EndName>& names) {
  MeshAttribute face{"ModelFaceID", {}, true}, cap{"CapID", {}, true};
  for (const Index label : ends.cap_label) {
    face.values.push_back(1.0 + label);
    cap.values.push_back(label > 0 ? label : -1.0);
  }
  attributes.face.push_back(std::move(face));
  attributes.face.push_back(std::move(cap));
  attributes.patch_names = {"wall"};
  for (const FlatEnd& end : ends.ends) {
    while (attributes.patch_names.size() < end.label)  // ends that are not flat
      attributes.patch_names.push_back("cap_" + std::to_string(attributes.patch_names.size()));
    attributes.patch_names.push_back(name_of_end(end, names));
  }
}

Index divide_wall(MeshAttributes& attributes) {
  const MeshAttribute* branch = find_attribute(attributes.face, "branch");
  if (branch == nullptr) throw InvalidInput("the wall cannot be divided: faces have no branch");
  const std::vector<double> branches = branch->values;
  if (find_attribute(attributes.face, "ModelFaceID") == nullptr)
    attributes.face.push_back({"ModelFaceID", std::vector<double>(branches.size(), 1), true});
  const auto numbers = std::find_if(attributes.face.begin(), attributes.face.end(),
                                    [](const MeshAttribute& a) { return a.name == "ModelFaceID"; });
  std::map<double, double> number_of_branch;
  for (std::size_t f = 0; f < branches.size(); ++f) {
    if (numbers->values[f] == 1) number_of_branch[branches[f]] = 0;
  }
  std::vector<std::string> names;
  for (auto& [label, number] : number_of_branch) {
    names.push_back("wall_" + std::to_string(static_cast<Index>(label)));
    number = static_cast<double>(names.size());
  }
  const auto walls = static_cast<Index>(names.size());
  for (std::size_t f = 0; f < branches.size(); ++f) {
    double& number = numbers->values[f];
    number = number == 1 ? number_of_branch.at(branches[f]) : number - 1 + walls;
  }
  if (!attributes.patch_names.empty())
    names.insert(names.end(), attributes.patch_names.begin() + 1, attributes.patch_names.end());
  attributes.patch_names = std::move(names);
  return walls;
}

}  // namespace vmesh

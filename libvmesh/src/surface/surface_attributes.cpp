#include "vmesh/surface/surface_attributes.h"

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

}  // namespace vmesh

#include "vmesh/surface/surface_attributes.h"

#include <algorithm>
#include <map>

#include <tbb/parallel_for.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/branch_labels.h"

namespace vmesh {
AttributeBlocks::AttributeBlocks(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                                 const std::vector<double>& radius, const std::vector<Opening>& openings,
                                 const Centerline& centerline)
    : mesh_(mesh),
      binding_(binding),
      radius_(radius),
      has_openings_(!openings.empty()),
      label_(branch_label_of_cones(centerline)) {
  check_bindings(mesh, binding, label_.size());
  for (Index i = 0; i < openings.size(); ++i) {
    for (const Index v : openings[i].ring) opening_.emplace_back(v, i + 1);
  }
  std::sort(opening_.begin(), opening_.end());
}

std::vector<MeshAttribute> AttributeBlocks::of_vertices(std::size_t begin, std::size_t end) const {
  MeshAttribute radius{"radius", {}}, segment{"segment", {}, true}, parameter{"parameter", {}},
      branch{"branch", {}, true};
  for (MeshAttribute* attribute : {&radius, &segment, &parameter, &branch}) attribute->values.reserve(end - begin);
  if (!radius_.empty()) radius.values.assign(radius_.begin() + begin, radius_.begin() + end);
  for (auto v = static_cast<Index>(begin); v < end; ++v) {
    segment.values.push_back(binding_[v].segment);
    parameter.values.push_back(binding_[v].t);
    branch.values.push_back(branch_of(v));
  }
  std::vector<MeshAttribute> attributes;
  for (MeshAttribute* attribute : {&radius, &segment, &parameter, &branch}) attributes.push_back(std::move(*attribute));
  if (has_openings_) {
    MeshAttribute opening{"opening", std::vector<double>(end - begin, 0), true};
    const auto first =
        std::lower_bound(opening_.begin(), opening_.end(), std::pair(static_cast<Index>(begin), Index{0}));
    for (auto it = first; it != opening_.end() && it->first < end; ++it)
      opening.values[it->first - begin] = it->second;  // of several the last
    attributes.push_back(std::move(opening));
  }
  return attributes;
}

std::vector<MeshAttribute> AttributeBlocks::of_faces(std::size_t begin, std::size_t end) const {
  MeshAttribute skewness{"EquiangleSkewness", std::vector<double>(end - begin)},
      branch{"branch", std::vector<double>(end - begin), true};
  tbb::parallel_for(begin, end, [&](std::size_t f) {
    const auto& [a, b, c] = mesh_.faces[f];
    skewness.values[f - begin] = equiangle_skewness(mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]);
    branch.values[f - begin] = label_of_face(branch_of(a), branch_of(b), branch_of(c));
  });
  std::vector<MeshAttribute> attributes;
  attributes.push_back(std::move(skewness));
  attributes.push_back(std::move(branch));
  return attributes;
}

MeshAttributes surface_attributes(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                                  const std::vector<double>& radius, const std::vector<Opening>& openings,
                                  const Centerline& centerline) {
  const AttributeBlocks blocks(mesh, binding, radius, openings, centerline);
  MeshAttributes attributes;
  attributes.vertex = blocks.of_vertices(0, mesh.vertices.size());
  attributes.face = blocks.of_faces(0, mesh.faces.size());
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

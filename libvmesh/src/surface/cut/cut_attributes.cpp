#include <algorithm>

#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/cut_surface.h"

namespace vmesh {
namespace {

void carry_vertex_values(const CutSurface& surface, MeshAttribute& attribute) {
  const std::vector<double> before = std::move(attribute.values);
  attribute.values.clear();
  for (const auto& [a, b, share] : surface.vertex_origin) {
    const double value = (1 - share) * before[a] + share * before[b];
    attribute.values.push_back(attribute.integer ? before[share > 0.5 ? b : a] : value);
  }
}

/// Of all vertices of both caps.
void set_on_caps(const CutSurface& surface, double value, MeshAttribute& attribute) {
  for (const CutSurface::Cap& cap : surface.cap) {
    for (Index f = cap.first_face; f < cap.first_face + cap.face_count; ++f) {
      for (const Index v : surface.mesh.faces[f]) attribute.values[v] = value;
    }
  }
}

/// Faces keep theirs; those of the caps get one of `of_caps`.
void carry_face_values(const CutSurface& surface, const std::array<double, 2>& of_caps, MeshAttribute& attribute) {
  std::vector<double> after;
  for (Index f = 0; f < surface.face_origin.size(); ++f) {
    const Index from = surface.face_origin[f];
    after.push_back(from == kNone ? of_caps[f >= surface.cap[1].first_face ? 1 : 0] : attribute.values[from]);
  }
  attribute.values = std::move(after);
}

double largest_of(const std::vector<double>& values) {
  return values.empty() ? 0 : std::max(0.0, *std::max_element(values.begin(), values.end()));
}

/// The value of the face next to a cap.
double beside_cap(const CutSurface& surface, std::size_t side, const std::vector<double>& before) {
  const std::vector<Index>& ring = surface.cap[side].ring;
  for (Index f = 0; f < surface.face_origin.size(); ++f) {
    if (surface.face_origin[f] == kNone) continue;
    for (const Index v : surface.mesh.faces[f])
      if (v == ring[0]) return before[surface.face_origin[f]];
  }
  return 0;
}

std::array<double, 2> values_of_caps(const CutSurface& surface, const MeshAttribute& attribute) {
  const double last = largest_of(attribute.values);
  if (attribute.name == "ModelFaceID" || attribute.name == "CapID") return {last + 1, last + 2};
  return {beside_cap(surface, 0, attribute.values), beside_cap(surface, 1, attribute.values)};
}

/// A wall, if faces have no numbers of patches yet, and a name for every number.
void number_patches(std::size_t faces, MeshAttributes& attributes) {
  const MeshAttribute* patch = find_attribute(attributes.face, "ModelFaceID");
  if (patch == nullptr) {
    attributes.face.push_back({"ModelFaceID", std::vector<double>(faces, 1), true});
    attributes.patch_names = {"wall"};
    return;
  }
  const auto used = static_cast<std::size_t>(largest_of(patch->values));
  while (attributes.patch_names.size() < used)
    attributes.patch_names.push_back(
        attributes.patch_names.empty() ? "wall" : "cap_" + std::to_string(attributes.patch_names.size()));
}

}  // namespace

MeshAttributes attributes_of_cut(MeshAttributes attributes, const CutSurface& surface, const SegmentPlace& place,
                                 double radius, const std::array<std::string, 2>& cap_names) {
  for (MeshAttribute& attribute : attributes.vertex) {
    carry_vertex_values(surface, attribute);
    if (attribute.name == "segment") set_on_caps(surface, place.segment, attribute);
    if (attribute.name == "parameter") set_on_caps(surface, place.t, attribute);
    if (attribute.name == "radius") set_on_caps(surface, radius, attribute);
  }
  const auto faces = static_cast<std::size_t>(
      std::count_if(surface.face_origin.begin(), surface.face_origin.end(), [](Index f) { return f != kNone; }));
  const std::size_t before = attributes.face.empty() ? faces : attributes.face.front().values.size();
  number_patches(before, attributes);
  for (MeshAttribute& attribute : attributes.face) {
    carry_face_values(surface, values_of_caps(surface, attribute), attribute);
    if (attribute.name == "EquiangleSkewness") attribute.values = equiangle_skewness(surface.mesh);
  }
  attributes.patch_names.insert(attributes.patch_names.end(), cap_names.begin(), cap_names.end());
  return attributes;
}

}  // namespace vmesh

#include "named_patches.h"

#include <algorithm>
#include <cmath>

#include "vmesh/core/error.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/patch_names.h"

#include "text.h"

namespace vmesh::io {

void check_named_patches(const MeshAttributes& attributes) {
  if (attributes.patch_names.empty()) return;
  check_patch_names(attributes.patch_names, "patch", "patches");
  const MeshAttribute* labels = find_attribute(attributes.face, "ModelFaceID");
  if (labels == nullptr) return;
  for (std::size_t f = 0; f < labels->values.size(); ++f) {
    const double label = labels->values[f];
    if (label >= 1 && label <= static_cast<double>(attributes.patch_names.size()) && label == std::floor(label))
      continue;
    std::string number;
    append(number, label);
    throw InvalidInput("face " + std::to_string(f) + ": there is no name for ModelFaceID " + number + "; there are " +
                       std::to_string(attributes.patch_names.size()) + " names");
  }
}

void settle_patch_names(LoadedSurface& surface, const std::string& source) {
  try {
    check_named_patches(surface.attributes);
  } catch (const InvalidInput& error) {
    surface.attributes.patch_names.clear();
    surface.warnings.push_back(source + ": the names of patches are left out: " + error.what());
  }
}

void FaceGroups::begin(std::string name) {
  const auto found = std::find(names_.begin(), names_.end(), name);
  current_ = static_cast<Index>(found - names_.begin());
  if (found == names_.end()) names_.push_back(std::move(name));
}

void FaceGroups::finish(LoadedSurface& surface, const std::vector<Index>& face_of_triangle) const {
  if (group_of_face_.empty()) return;
  std::vector<Index> number(names_.size(), kNone);  // from 0, of the groups that have faces
  std::vector<std::string> names;
  for (const Index f : face_of_triangle) {
    Index& of_group = number[group_of_face_[f]];
    if (of_group != kNone) continue;
    of_group = static_cast<Index>(names.size());
    names.push_back(names_[group_of_face_[f]]);
  }
  if (names.size() < 2) return;
  MeshAttribute labels{"ModelFaceID", {}, true};
  for (const Index f : face_of_triangle) labels.values.push_back(number[group_of_face_[f]] + 1.0);
  surface.attributes.face.push_back(std::move(labels));
  surface.attributes.patch_names = std::move(names);
}

}  // namespace vmesh::io

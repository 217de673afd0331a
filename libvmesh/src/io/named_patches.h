// Patches of surfaces by names, as files tell them. Internal to the module.
#pragma once

#include <string>
#include <vector>

#include "vmesh/io/surface_io.h"

namespace vmesh::io {

/// Throws InvalidInput unless the names are good (check_patch_names()), and there is one for every ModelFaceID.
void check_named_patches(const MeshAttributes& attributes);

/// Takes what a file says of names; leaves it out, with a warning, where check_named_patches() would throw.
void settle_patch_names(LoadedSurface& surface, const std::string& source);

/// Collects the groups or solids of a text file, whose faces become patches if there is more than one.
class FaceGroups {
 public:
  /// The faces that follow are of this group.
  void begin(std::string name);
  /// The next face is of the current group.
  void add_face() { group_of_face_.push_back(current_); }
  /// Adds ModelFaceID and the names. `face_of_triangle`: the face that every triangle comes from.
  void finish(LoadedSurface& surface, const std::vector<Index>& face_of_triangle) const;

 private:
  std::vector<std::string> names_ = {""};
  std::vector<Index> group_of_face_;
  Index current_ = 0;
};

}  // namespace vmesh::io

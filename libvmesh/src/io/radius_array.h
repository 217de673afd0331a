// Arrays, columns and attributes that hold radii, or what radii follow from, by their names; internal to the module.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vmesh/centerline/raw_centerline.h"

namespace vmesh::io {

class RadiusArray {
 public:
  explicit RadiusArray(std::string name);

  /// From one of its numbers: half of a diameter ("diam" is in the name), the radius of a circle of that area ("area"
  /// is, but no "radi").
  double radius(double number) const;

  /// Names it in `raw` as what holds the radii, with a warning if these are not its numbers themselves.
  void note(RawCenterline& raw) const;

 private:
  enum class Holds { radii, diameters, areas };

  static Holds what_by(const std::string& name);

  std::string name_;
  Holds holds_;
};

/// The only one of the names that is that of an area; nullopt if there is none or several.
std::optional<std::string> only_area(const std::vector<std::string>& names);

}  // namespace vmesh::io

#include "solid/fan_direction.h"

#include <algorithm>

namespace vmesh {
namespace {

// A vector shorter than this has no direction that rounding would not change.
constexpr double kShortest = 1e-12;

class BestOf {
 public:
  explicit BestOf(const std::vector<Vec3>& normals) : normals_(normals) {}

  void try_along(const Vec3& vector) {
    const double length = vector.norm();
    if (!(length > kShortest)) return;
    const Vec3 way = vector / length;
    double least = 1;
    for (const Vec3& normal : normals_) {
      least = std::min(least, way.dot(normal));
      if (least <= best_.least) return;
    }
    best_ = {way, least};
  }

  const FanDirection& best() const { return best_; }

 private:
  const std::vector<Vec3>& normals_;
  FanDirection best_;
};

}  // namespace

// The narrowest cone touches one, two or three of the normals.
FanDirection best_direction(const std::vector<Vec3>& normals) {
  BestOf found(normals);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    found.try_along(normals[i]);
    for (std::size_t j = 0; j < i; ++j) {
      found.try_along(normals[i] + normals[j]);
      for (std::size_t k = 0; k < j; ++k) {
        const Vec3 axis = (normals[j] - normals[i]).cross(normals[k] - normals[i]);
        found.try_along(axis.dot(normals[i]) < 0 ? Vec3(-axis) : axis);
      }
    }
  }
  return found.best();
}

FanDirection best_direction_in_plane(const std::vector<Vec3>& normals, const Vec3& plane) {
  BestOf found(normals);
  const auto within = [&](const Vec3& v) -> Vec3 { return v - plane.dot(v) * plane; };
  for (std::size_t i = 0; i < normals.size(); ++i) {
    found.try_along(within(normals[i]));
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 axis = within(plane.cross(normals[i] - normals[j]));
      found.try_along(axis.dot(normals[i]) < 0 ? Vec3(-axis) : axis);
    }
  }
  return found.best();
}

}  // namespace vmesh

#pragma once

#include <cstddef>
#include <vector>

#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// Where a surface could not be refined to a limit, and is to be grown finer. Mostly walls that part at a small angle:
/// edges longer than the gap between them span it, and refining does not always find a way down. How fine it must be
/// is chance as much as geometry, so that every place has draws of its own until one does.
class FinePlaces {
 public:
  /// Keeps a reference.
  FinePlaces(const VesselField& field, const ErrorLimit& limit) : field_(&field), limit_(limit) {}

  const std::vector<FinePlace>& places() const { return places_; }
  bool operator==(const FinePlaces& other) const { return places_ == other.places_; }

  /// Takes the next draw wherever the last was not proven. Returns whether there is any left.
  bool draw(const std::vector<UnprovenPlace>& unproven);

 private:
  void add(const Vec3& center);
  void take_draw(std::size_t place);

  const VesselField* field_;
  ErrorLimit limit_;
  std::vector<FinePlace> places_;
  std::vector<std::size_t> draws_;  // by place: the one it has now
};

}  // namespace vmesh

#include "radius_array.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "text.h"

namespace vmesh::io {
namespace {

bool is_in(const std::string& name, std::string_view part) { return lower(name).find(part) != std::string::npos; }

bool names_an_area(const std::string& name) { return is_in(name, "area") && !is_in(name, "radi"); }

}  // namespace

RadiusArray::RadiusArray(std::string name) : name_(std::move(name)), holds_(what_by(name_)) {}

RadiusArray::Holds RadiusArray::what_by(const std::string& name) {
  if (is_in(name, "diam")) return Holds::diameters;
  return names_an_area(name) ? Holds::areas : Holds::radii;
}

double RadiusArray::radius(double number) const {
  if (holds_ == Holds::radii) return number;
  if (holds_ == Holds::diameters) return number / 2;
  // What is negative stays so, for cleaning to name the place.
  return std::copysign(std::sqrt(std::abs(number) / std::numbers::pi), number);
}

void RadiusArray::note(RawCenterline& raw) const {
  raw.radius_arrays = {one_line(name_)};
  if (holds_ == Holds::diameters) raw.warnings.push_back(raw.source + ": radii are half of " + cite(name_));
  if (holds_ == Holds::areas)
    raw.warnings.push_back(raw.source + ": radii are those of circles of the area " + cite(name_));
}

std::optional<std::string> only_area(const std::vector<std::string>& names) {
  if (std::ranges::count_if(names, names_an_area) != 1) return std::nullopt;
  return *std::ranges::find_if(names, names_an_area);
}

}  // namespace vmesh::io

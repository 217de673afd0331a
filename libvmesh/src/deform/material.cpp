#include "vmesh/deform/material.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "vmesh/core/error.h"

#include "deform/short_segment.h"

namespace vmesh {
namespace {

void require(bool good, const char* name, double value, const char* range) {
  if (!good)
    throw InvalidInput(std::string("material: ") + name + " is " + std::to_string(value) + "; it must be " + range);
}

void check(const Material& m) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  require(positive(m.young_Pa), "Young's modulus (Pa)", m.young_Pa, "finite and above 0");
  require(positive(m.density_kg_m3), "the density (kg/m3)", m.density_kg_m3, "finite and above 0");
  require(m.poisson_ratio >= 0 && m.poisson_ratio <= 0.5, "Poisson's ratio", m.poisson_ratio, "in [0, 0.5]");
  require(std::isfinite(m.wall_mm) && m.wall_mm >= 0, "the wall (mm)", m.wall_mm, "finite and at least 0");
  require(m.wall_ratio > 0 && m.wall_ratio <= 1, "the wall ratio", m.wall_ratio, "in (0, 1]");
  require(std::isfinite(m.damping_s) && m.damping_s >= 0, "the damping time (s)", m.damping_s, "finite and at least 0");
}

SegmentProperties properties_of(double length, double radius, const Material& m) {
  const double wall = std::min(m.wall_mm > 0 ? m.wall_mm : m.wall_ratio * radius, radius);
  const double outer2 = radius * radius, inner2 = (radius - wall) * (radius - wall);
  const double area = std::numbers::pi * (outer2 - inner2);
  const double second_moment = area * (outer2 + inner2) / 4;
  const double young_N_mm2 = 1e-6 * m.young_Pa;
  const double mass = 1e-9 * m.density_kg_m3 * area * regular_length(length, radius);
  return {.stretch_N = young_N_mm2 * area,
          .bend_N_mm2 = young_N_mm2 * second_moment,
          .twist_N_mm2 = young_N_mm2 * second_moment / (1 + m.poisson_ratio),
          .mass_kg = mass,
          .inertia_kg_mm2 = mass * (outer2 + inner2) / 4,
          .damping_s = m.damping_s,
          .squeeze_N_mm2 = young_N_mm2 * wall / radius};
}

}  // namespace

std::vector<SegmentProperties> segment_properties(const Centerline& centerline, const Material& material) {
  check(material);
  std::vector<SegmentProperties> properties;
  for (Index s = 0; s < centerline.segments().size(); ++s)
    properties.push_back(properties_of(centerline.length(s), centerline.radius_at(s, 0.5), material));
  return properties;
}

}  // namespace vmesh

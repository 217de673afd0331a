#pragma once

namespace vmesh {

/// Radius of a ring of `around` vertices in balanced placement, in vessel radii: an edge of length h cuts off h^2 / 8,
/// faces half of that on average.
double balanced_ring_radius(double around);

/// Share of the error limit up to which vertices are lifted; the rest is left for the faces between them.
inline constexpr double kShareOfLimit = 0.95;  // safe 0.66 to 1.3

/// Target edge length in vessel radii at `around` vertices around a vessel.
double edge_length_per_radius(double around);

/// How deep an edge of this length across a vessel cuts into it, mm.
inline double cut_off(double edge, double radius) { return edge * edge / (8 * radius); }

/// Longest edge, mm, with which a surface in balanced placement stays within `limit` (mm) of a vessel of `radius`.
double edge_length_for(double limit, double radius);

}  // namespace vmesh

#pragma once

#include "surface/junction/junction_centerline.h"

namespace vmesh {

/// A vessel far thinner than the junction that it leaves through an opening.
struct Thread {
  Index gap = kNone;
  bool at_end = false;  ///< which opening of the gap
  double root = 0;      ///< place below the wall of thicker vessels where the thread can be cut off unseen
  CrossSection exit;    ///< where it leaves them, once known (find_exit); the normal points outwards
};

/// The openings of a junction's vessels that are too narrow for a lattice of that spacing, where the vessel comes from
/// a node: they may be threads. Their roots are not known yet.
std::vector<Thread> narrow_openings(const std::vector<BranchAxis>& axes, const Junction& junction, double spacing);

/// Of those the threads, with their roots. `volume` and `local` are the junction's own.
std::vector<Thread> find_threads(const std::vector<Thread>& narrow, const VesselField& volume,
                                 const JunctionCenterline& local, const std::vector<BranchAxis>& axes,
                                 const Junction& junction);

/// The junction with its threads cut off at their roots.
Junction without_threads(Junction junction, const std::vector<Thread>& threads);

/// Where a thread leaves `rest`, the volume without it. `gap` is the whole one, `stub` the cone of `rest` that ends at
/// the thread's root.
CrossSection find_exit(const Thread& thread, const BranchAxis& axis, const Gap& gap, const VesselField& rest,
                       Index stub);

}  // namespace vmesh

#pragma once

#include <cstddef>
#include <vector>

#include "vmesh/fit/fit_surface.h"

#include "fit/correspondence.h"
#include "fit/fit_steps.h"
#include "fit/resizing.h"

namespace vmesh::fitting {

/// The rounds of a fit: sizes of triangles towards a number of vertices or an error, then long triangles or places that
/// are far. Keeps references.
class Fit {
 public:
  Fit(const VesselSurface& surface, const VesselField& field, const TriMesh& reference, const FitOptions& options);
  const FitReference& reference() const { return reference_; }
  const FitMesh& surface() const { return surface_; }
  int rounds() const { return rounds_; }
  /// Throws InvalidInput if the reference is nowhere near the surface, Unsupported without memory, Cancelled.
  void run(const Progress& progress);
  /// Without a report.
  FitResult result();
  /// Without components that belong to no vessel, of which it tells the report.
  TriMesh reference_without_apart(FitReport& report) const;

 private:
  // That 95 % are to keep.
  static double wanted_error(const FitOptions& options);
  void check_matched(const Matches& matches) const;
  void report_round();
  Matches next_matches(bool coarse = false);
  // Takes a step; returns the matches with the distances after it.
  Matches matches_after_step();
  // Returns whether there were any; matches are then outdated.
  bool remove_buried(const Matches& matches);
  Matches matches_now(bool coarse);
  // The last rounds: distance takes precedence over shape.
  void finish();
  bool is_long() const { return options_.elongation > 1; }
  std::size_t vertices_before_subdivision() const;
  void make_long();
  // With as few vertices as the error allows, of which there are about so many that it is inversely proportional to
  // them.
  void make_long_to_error();
  // A fit of many even triangles.
  void make_dense(int subdivisions);
  void make_long(std::size_t vertices);
  double p95() const;
  bool keeps_error() const { return p95() <= error_; }
  // Of the faces that do not keep the largest error, mm^2.
  double area_beyond() const;
  // Again with a smaller error around vertices.
  void correct(double factor);
  // Vertices where they are needed, then finer triangles everywhere.
  void reach_max_error();
  // Corrects as long as that mends a part of what does not keep the largest error; takes back what did not. `correct`
  // returns whether there was anything left to try.
  template <class Correct>
  void mend_beyond(Correct&& correct);
  void step(const Matches& matches) { step_nearer(surface_, matches, setting_); }
  // `first`: rounds are left to repair triangles that flips make skew.
  void reshape(int power, bool first);
  // Resizes triangles; for an error, until the number of vertices has settled.
  void resize();
  // Leaves some of them for bring_farthest_nearer().
  void keep_to_wanted_vertices();
  void resize_once(const Matches& matches);
  // Adapts the error wanted around vertices so that 95 % of the distances are below options.error.
  void aim_at_error(double p95);

  const VesselField& field_;
  const FitOptions& options_;
  double error_;   // mm, kept by 95 %; 0: any
  bool to_error_;  // sizes follow an error; otherwise (no error given, or too many vertices) a number of vertices
  FitReference reference_;
  FitSetting setting_;
  FitMesh surface_;
  std::vector<Opening> openings_;
  std::vector<ReferenceSample> samples_, few_samples_, samples_and_rims_;
  std::size_t most_vertices_ = 0, wanted_vertices_ = 0;  // of even triangles
  std::size_t long_vertices_ = 0;                        // wanted, if the triangles are to be long
  double even_error_ = 0;                                // mm, wanted everywhere
  bool settled_ = false;                                 // the number of vertices
  int rounds_ = 0;
  const Progress* progress_ = nullptr;
  double aim_ = 1;  // correction to the number of vertices asked for
  SizeLimits limits_;
};

/// Checks for the memory that a fit of `vertices` vertices needs at most, with the reference. Throws Unsupported.
void check_memory(std::size_t vertices, const TriMesh& reference);

std::vector<FitVertex> vertices_of(const VesselSurface& surface);

}  // namespace vmesh::fitting

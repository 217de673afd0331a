#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "vmesh/core/box_tree.h"
#include "vmesh/volume/cone_relations.h"
#include "vmesh/volume/round_cone.h"

namespace vmesh {

struct ConeLanes;

/// The vessel volume of a centerline: the union of its round cones (convex hulls of two spheres), as a signed
/// distance. Cone i < segments().size() belongs to segment i; then follow the isolated nodes as spheres.
///
/// The distance to one cone is exact. The distance to the union is exact outside and on the boundary; inside it is a
/// lower bound of the depth, so that a step of |distance| never leaves the volume. With `blend` > 0 branches are
/// rounded: where two cones of radii r1, r2 meet under gradients g1, g2 the minimum is smooth over a width of blend *
/// min(r1, r2) * (1 - g1.g2); along a straight chain the gradients agree and, up to blend 1, nothing bulges. Where
/// vessels part and come near again, as around a tight turn, there is less rounding, so that their walls stay apart.
///
/// Local queries carry a hint, the cone they were last closest to; only cones local to it take part: those whose
/// spheres it touches without a break from a common point on, beyond that up to where the rounding between parting
/// vessels ends, and those between which the rounding covers it: so the boundary has no step. A blend above 0.5 is
/// reduced where vessels part, so that it ends there. Vessels that part and come near again, or come close in space but
/// not along the graph, are not local to each other. Global queries take every cone into account, for evaluation.
class VesselField {
 public:
  /// `blend` in [0, 2]. Keeps a reference to `centerline`, which must outlive the field.
  explicit VesselField(const Centerline& centerline, double blend = 0);

  /// The part of another field from which `excerpt` was taken; `centerline` is the excerpt's. Local queries whose hints
  /// are complete in it, and distance_to_others() within its reach, answer as the other field does, to the bit. A query
  /// that leads to another hint throws std::logic_error. Global queries cover the excerpt only.
  VesselField(const Centerline& centerline, const FieldExcerpt& excerpt);

  /// The cones themselves.
  const ConeRelations& relations() const { return relations_; }

  /// Signed distance at `p` from the cones local to `hint`. The closest cone becomes the next hint until it no longer
  /// changes.
  FieldSample sample(const Vec3& p, Index hint) const;

  /// The same in single precision, several cones at a time and accurate to a few 1e-5 of the local radius: for steps
  /// that are verified by other means. Uses double precision where vessels are very long or thin beside their
  /// neighbours. Same bits on every machine of one architecture.
  FieldSample sample_fast(const Vec3& p, Index hint) const;
  /// Makes sample_fast() use double precision, too: for surfaces whose triangles are proven as they grow.
  void use_double_precision() { only_double_ = true; }

  /// Signed distance of the union of all cones at `p`.
  FieldSample sample_global(const Vec3& p) const;

  /// Signed distance at `p` to the nearest cone that is not local to `cone`, if that is less than `limit`, else
  /// `limit`.
  double distance_to_others(const Vec3& p, Index cone, double limit) const;

  /// Exact signed distance to one cone.
  FieldSample sample_cone(const Vec3& p, Index cone) const;

  /// Whether two cones are blended where both are near: not if their vessels have parted and come near again.
  bool are_blended(Index i, Index j) const;

  /// A superset of those ConeRelations::local_cones(cone) whose distance at `p` (mm), less the widest blend, is at most
  /// `limit` (mm); ascending. Uses a search in space where there are many, as around a node of many branches.
  void local_cones_near(const Vec3& p, Index cone, double limit, std::vector<Index>& near) const;

 private:
  friend class ConeRelations;

  struct Cone : RoundCone {
    Cone() = default;
    Cone(const RoundCone& cone, Index first, Index last) : RoundCone(cone), a(first), b(last) {}

    double rounding_at(double t) const { return rounding0 + t * (rounding1 - rounding0); }

    double rounding0 = 1, rounding1 = 1;  // shares of the blend
    Index a = kNone, b = kNone;
    bool is_apart = false;  // apart from some other: listed in relations_
  };
  using Distance = RoundCone::Distance;
  // At points farther from `center` than `reach` plus the distance of the nearest cone, the cone is neither nearest nor
  // blended.
  struct Sphere {
    Vec3 center = Vec3::Zero();
    double reach = 0;
  };
  struct Candidate {
    double value, t;
    Index cone;
    double reach = 0;  // of the blend, mm
    Vec3 gradient = Vec3::Zero();
  };

  static Cone make_cone(const Centerline& centerline, Index a, Index b);
  static FieldSample sample_of(const Cone& cone, const Vec3& p, Index number);
  double max_radius(Index cone) const { return std::max(cones_[cone].r0, cones_[cone].r1); }
  // `first`: one of the cones, likely to be near.
  FieldSample blended(const Vec3& p, std::span<const Index> cones, Index first) const;
  FieldSample blended_local(const Vec3& p, Index hint) const;
  template <class Visit>
  void visit_near(const Vec3& p, const double& limit, Visit&& visit) const {
    tree_.visit(p, limit, [&](Index item) { visit(cone_of_item_[item]); });
  }
  std::span<Candidate> at_different_places(std::span<Candidate> candidates) const;
  void blend_candidates(const Vec3& p, std::span<Candidate> candidates, FieldSample& sample) const;
  struct Vicinity;
  const Vicinity& vicinity(Index hint, double t) const;
  void survey_vicinity(Vicinity& vicinity) const;
  struct Surroundings;
  const Surroundings& surroundings(Index hint) const;
  void survey(Index hint, Surroundings& surroundings) const;
  bool all_are_blended(std::span<const Index> cones) const;
  bool is_lonely(Index cone, const Vec3& low, const Vec3& high) const;
  void fill_lanes(std::span<const Index> cones, const Vec3& center, double per_unit, ConeLanes& lanes) const;
  static std::uint64_t new_number();
  void finish();
  void make_cones();
  void measure_spheres();
  void build_tree();

  ConeRelations relations_;
  double blend_;
  bool only_double_ = false;
  std::uint64_t number_ = new_number();  // of this field and its copies, which are equal
  std::vector<Cone> cones_;
  std::vector<Sphere> spheres_;
  BoxTree tree_;                     // of pieces of cones
  std::vector<Index> cone_of_item_;  // in the tree
  // For every cone: whether only local ones are near, once that has been determined.
  enum Lonely : char { not_asked, lonely, in_company };
  mutable std::vector<char> lonely_;
};

}  // namespace vmesh

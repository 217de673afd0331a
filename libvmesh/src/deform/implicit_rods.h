#pragma once

#include <algorithm>
#include <vector>

#include "deform/one_lane.h"
#include "deform/rod_batch.h"
#include "deform/rod_kernels.h"
#include "deform/rod_scene.h"
#include "deform/surroundings.h"

namespace vmesh {

inline double sum(const Lanes& lanes) {
  double total = 0;
  for (std::size_t i = 0; i < kLanes; ++i) total += lanes[i];
  return total;
}

inline double largest(const Lanes& lanes) {
  double most = 0;
  for (std::size_t i = 0; i < kLanes; ++i) most = std::max(most, lanes[i]);
  return most;
}

/// Implicit Euler on the energy of the springs: every step minimises
///   sum m / (2 h^2) |p - p_predicted|^2 + elastic energy + damping,
/// the same with the tips of the x and y axes for the frames, by Gauss-Newton plus the geometric stiffness of tension.
/// Each iteration is one exact solution on the tree, O(n), four slots of one height at a time. Updates that would raise
/// the sum are halved, so it never exceeds its value for standing still; afterwards, velocities are scaled down where
/// kinetic and elastic energy exceed the previous energy plus the work done. Only moving slots, those next to them and
/// those towards the root are visited.
class ImplicitRods {
 public:
  explicit ImplicitRods(const RodScene& scene, InstructionSet set = best_instruction_set());

  void wake(Index slot);
  void wake_all();
  StepReport step(RodScene& scene) noexcept;

  /// From now on, slots meet these. They must outlive this.
  void attach(const RodScene& scene, Surroundings& around);
  /// Sets the spring of a slot to the tissue around it.
  void set_tissue(const RodScene& scene, Index slot, const TissueSpring& spring);
  /// The force with which a held slot is held, as of the last step, mN.
  Vec3 holding_force(const RodScene& scene, Index slot) const;

 private:
  using FourFlags = std::array<char, kLanes>;
  /// The elimination of a slot that something acts on.
  struct Loaded {
    bool done = false;
    Mat6 own;  // of y: own stiffness and that across to the parent
    Vec6 gradient;
    Eigen::LDLT<Mat6> sum;
  };
  /// A linked slot, or one between such a slot and its root.
  struct Joint {
    Index place = kNone, parent = kNone;  // the latter: number of a joint; kNone at a root
    Hold hold = Hold::free;
    Loaded* loaded = nullptr;
    Vec3 z = Vec3::UnitZ(), lever = Vec3::Zero();
    double stretch = 0, bend = 0, twist = 0;  // compliance of the spring to the parent
    Mat6 reduced;                             // as in RodBatch; of a root: its compliance
    Vec6 before;  // gradient that elimination has passed on, or left where something acts; of a root: x
    Vec6 force, carried, passed, way;
  };
  /// Joints at which a link pulls, two at either end or one at a root.
  struct LinkEnds {
    std::size_t count = 0;
    std::array<Index, 4> joint{};
    std::array<Vec3, 4> pull;
  };

  StepReport step_among(RodScene& scene);
  double iterate_among(RodScene& scene, bool first, double goes, StepReport& report);
  void begin_slots(RodScene& scene);
  void begin_batch(const RodScene& scene, Index batch, const char* active);
  bool is_done(const RodScene& scene, const StepReport& report, bool stands) const;
  void solve_among(const RodScene& scene, const RodMove& by, double goes);
  double look_at(const RodScene& scene, const RodMove& by, double goes);
  bool is_lower(const RodScene& scene, const RodMove& by, double standing, double goes);
  double straighten(const RodScene& scene, RodMove& by, double free, double goes);
  void move_part(const RodScene& scene, const RodMove& by, double goes);
  static void shorten(RodMove& by, double free, int attempt);
  void bind_to_tissue(Index batch, const char* active);
  void linearise(double part);
  void take_loads();
  void eliminate_loaded(Index batch);
  void eliminate_loaded(const SegmentLoad& load, Index place, Loaded& loaded);
  void substitute_loaded(const RodScene& scene, Index batch, const FourFlags& rests);
  Mat6 stiffness_below(Index place) const;
  void solve_links(const RodScene& scene, const RodMove* then);
  void collect_links(const RodScene& scene);
  void set_joints(const RodScene& scene);
  Joint joint_at(Index place);
  static Vec6 passed_on(Joint& joint);
  static Vec6 yielding(const Joint& joint, const Vec6& force);
  void give_way();
  void pull_links(const Eigen::VectorXd& force);
  template <class Way>
  void open_links(const Way& way, Eigen::VectorXd& opening) const;
  void let_go_on(double part);
  void restore_roots();
  void aim_held(const RodScene& scene, double part);
  void read_positions(std::size_t pose, std::vector<Vec3>& into) const;
  double standing_energy(const RodScene& scene, double standing, double goes);
  void end_among(RodScene& scene);
  void tear(const RodScene& scene);

  void wake_place(Index place);
  void choose_visited();
  void visit(Index place);
  void visit_children(Index place);
  template <class Visit>
  void for_children(Index place, Visit visit) const {
    const RodBatch& b = batches_.batches[place / kLanes];
    for (Index rank = 0; rank < b.child_ranks; ++rank) {
      const Index child = batches_.children[b.first_children + rank][place % kLanes];
      if (child < visited_.size()) visit(child);
    }
  }
  void note_pulled(Index batch);

  double iterate(RodScene& scene, bool first, StepReport& report);
  /// `then`: the move to make once the solution is known; null: none.
  void solve(const RodScene& scene, const RodMove* then);
  void eliminate(Index batch);
  void eliminate_all();
  void substitute_all(const RodScene& scene, const RodMove* then);
  void solve_tree(const RodScene& scene, const RodMove* then);
  void solve_growing(const RodScene& scene, const RodMove* then);
  void solve_ties(const RodScene& scene, const RodMove* then);
  void solve_loaded(const RodScene& scene, const std::vector<Vec3>& load, std::vector<Vec3>& opening,
                    const RodMove* then);
  void solve_batch(const RodScene& scene, Index batch, const RodMove* then);
  FourFlags resting(const RodScene& scene, Index batch) const;
  void wake_children(Index batch);
  void move(const RodMove& by);

  Vec3 position(Index place, std::size_t pose) const;
  Vec3 pull(Index place, std::size_t pose) const;
  double drag_energy(std::size_t pose, double part) const;
  double tie_energy(const RodScene& scene, double pulled) const;

  void finish(RodScene& scene, StepReport& report);
  double govern(RodScene& scene, const FinishSums& sums) const;
  void settle(RodScene& scene, Index place, bool quiet);

  const RodKernels* kernels_;
  RodBatches batches_;
  std::vector<char> visited_, fresh_, awake_, quiet_steps_;  // by place
  std::vector<char> listed_;                                 // by batch: in one of the following
  std::vector<Index> visited_batches_, grown_batches_;       // ascending; a heap
  std::vector<Index> awake_places_, pulled_places_;
  std::size_t awake_count_ = 0, slot_count_ = 0;
  bool all_visited_ = false;
  bool eliminated_ = false;  // all visited slots, in their present state

  std::size_t pose_ = 0;  // index of the current pose
  BeginSums begin_sums_;
  MoveSums move_sums_;
  double energy_bound_ = 0;  // of the step: the value for standing still
  double start_tie_energy_ = 0;
  std::size_t steps_ = 0;

  // With surroundings: what they add to the energies and the work of govern(), uJ.
  Surroundings* around_ = nullptr;
  double around_before_ = 0, around_after_ = 0, around_work_ = 0;
  double tissue_offset_ = 0;  // of the objective, left out of its sums
  double rounding_ = 0;       // of the energy of a tree at rest, uJ
  double stride_ = 1;         // part of the rest of its way that everything is to go in an iteration
  double left_ = 0;           // of the way of what is dragged and of instruments, in this step
  bool blocked_ = false;      // the last iteration's move
  std::vector<Loaded> loaded_;
  std::vector<VesselLink> links_;
  std::vector<Joint> joints_;
  std::vector<LinkEnds> link_ends_;
  std::vector<std::pair<Index, Vec6>> moved_roots_;
  std::vector<Index> joint_of_place_;
  std::vector<Vec3> standing_;

  std::vector<Vec3> tie_load_, tie_residual_, tie_direction_, tie_image_, tie_opening_;
};

}  // namespace vmesh

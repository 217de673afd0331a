#pragma once

#include <vector>

#include "vmesh/deform/contact.h"

#include "deform/barrier.h"
#include "deform/rod_scene.h"
#include "deform/round_cones.h"
#include "deform/slot_boxes.h"
#include "deform/slot_origin.h"
#include "deform/tissue.h"

namespace vmesh {

/// What acts on one slot's segment, quadratic in the displacements u of its end and p of its beginning:
///   1/2 (p, u)^T K (p, u) + gradient_p p + gradient_u u.
struct SegmentLoad {
  Mat3 pp = Mat3::Zero(), pu = Mat3::Zero(), uu = Mat3::Zero();
  Vec3 gradient_p = Vec3::Zero(), gradient_u = Vec3::Zero();
};

/// What acts between two places on different segments: stiffness and slope along a direction, which points from the
/// second to the first.
struct VesselLink {
  Index first = kNone, second = kNone;  ///< slots
  double first_t = 0, second_t = 0;     ///< from the parent's position
  Vec3 direction = Vec3::Zero();
  double stiffness = 0, slope = 0;  ///< > 0, mN/mm; mN
};

/// A place that is held by jaws.
struct Jaw {
  Index slot = kNone;
  double t = 0;  ///< from the parent's position
  Vec3 at = Vec3::Zero(), aim = Vec3::Zero(), start = Vec3::Zero();
  double stiffness = 0;  ///< mN/mm
  double slips_mN = 0;   ///< largest force
  bool holds = true;

  /// Like a spring's up to slips_mN, then growing linearly: of the way from where the jaw is.
  double energy(double way) const {
    const double elastic = slips_mN / stiffness;
    return way <= elastic ? 0.5 * stiffness * way * way : slips_mN * (way - 0.5 * elastic);
  }
  double slope_over_way(double way) const { return stiffness * way <= slips_mN ? stiffness : slips_mN / way; }
};

/// What vessels meet: instruments, each other, and jaws that hold them; as a potential of the slots' positions and what
/// bounds a move. Instruments and jaws go from where they are to where they aim in as many parts as there are
/// iterations. Units as in Rod.
class Surroundings {
 public:
  /// The state of slots and instruments that an energy is of: the present one or the one on trial.
  enum class State { present, trial };

  Surroundings(const RodScene& scene, const ContactOptions& options);

  /// Goes on with the instruments and jaws of another one, after a cut; jaws still name slots of before. What never
  /// touched never will.
  void carry_on(const Surroundings& before, const std::vector<SlotOrigin>& origin);

  void set_options(const RodScene& scene, const ContactOptions& options);
  const ContactOptions& options() const { return options_; }
  Index add_instrument(const RodScene& scene, const InstrumentShape& shape, const InstrumentPose& pose);
  void aim_instrument(Index instrument, const InstrumentPose& pose);
  /// Takes it away; its number stays. Returns the slots near it.
  std::vector<Index> remove_instrument(Index instrument);
  bool is_there(Index instrument) const { return !instruments_[instrument].gone; }
  /// The gap between it and the nearest vessel; negative if they overlap, infinite without vessels.
  double room_for(const RodScene& scene, const InstrumentShape& shape, const InstrumentPose& pose) const;
  Index add_jaw(const RodScene& scene, Index slot, double t, double slips_mN);
  std::size_t instrument_count() const { return instruments_.size(); }
  std::vector<Jaw>& jaws() { return jaws_; }
  Tissue tissue;
  const std::vector<Jaw>& jaws() const { return jaws_; }

  /// The start of a step, from the scene's pose.
  void begin(const RodScene& scene);
  bool moves() const { return moves_; }  ///< some instrument or jaw is not where it aims
  /// A step in which everything else is at rest and nothing is near an instrument: they go where they aim.
  void go_alone();
  bool couples() const { return options_.self; }
  bool may_touch() const { return options_.self || !parts_.empty(); }
  /// Slots that what moves may touch in this step, or that a jaw holds.
  const std::vector<Index>& near_slots() const { return near_slots_; }

  const std::vector<Vec3>& present() const { return present_; }
  const std::vector<Vec3>& started() const { return start_; }  ///< at the start of the step
  std::vector<Vec3>& trial() { return trial_; }

  /// Slopes and stiffness at the present, for everything going `part` of the rest of its way.
  void linearise(double part);
  const std::vector<Index>& loaded_slots() const { return loaded_slots_; }
  const std::vector<SegmentLoad>& loads() const { return loads_; }
  Index load_index(Index slot) const { return load_of_slot_[slot]; }  ///< kNone: nothing acts on it
  const std::vector<VesselLink>& links() const { return links_; }
  /// Adds what stops pairs that would run into each other if slots went straight to the trial's positions, and
  /// everything `part` of the rest of its way. False if there is none.
  bool stop(const RodScene& scene, double part, bool revises);
  void forget_stops() { stops_.clear(); }
  bool loads_changed() const { return loads_changed_; }  ///< maybe, by the last stop(), and not only links

  /// Puts instruments and jaws on trial that go `part` of the rest of their way.
  void try_part(double part);
  /// How much of the move from the present to the trial is free of collisions.
  double free_part(const RodScene& scene);
  double energy(State state);
  /// Energy of instruments and jaws on trial with slots at `positions`.
  double energy_at(const std::vector<Vec3>& positions);
  void accept();

  /// The end of a step: forces, slipping of jaws. Returns the work done by instruments and jaws, uJ.
  double end(const RodScene& scene);
  /// Energy of barriers and jaws at the present, uJ.
  double stored() const;
  const InstrumentPose& instrument_pose(Index instrument) const { return instruments_[instrument].at; }
  HandForce instrument_force(Index instrument) const { return instruments_[instrument].force; }
  HandForce jaw_force(Index jaw) const;
  Vec3 slope_at(Index slot) const;  ///< of the potential in a slot's position, mN
  double smallest_gap() const;      ///< of the pairs that are near; infinite if there is none
  double precision() const;         ///< with which positions should be found, mm; infinite if nothing is near
  bool acts() const;                ///< some pair repels each other

 private:
  struct Instrument {
    InstrumentShape shape;
    InstrumentPose at, aim, start, trial;
    std::size_t first_point = 0;
    HandForce force;
    bool gone = false;
  };
  /// Two neighbouring points of an instrument, or one.
  struct Part {
    Index instrument, a, b;  // points_
    double radius_a, radius_b;
  };
  /// The slot nearest to a part.
  struct Nearest {
    Index slot = kNone;
    double gap = HUGE_VAL;
  };
  struct Points {
    std::vector<Vec3> present, trial, aim, start;
  };
  /// A slot and a part of an instrument, or another slot.
  struct ContactPair {
    Index slot, other;
    bool is_part;
    Barrier barrier;
    double rest_excess;  // the gap counts as larger by this: the two were nearer at rest
    ConeGap now, next;
  };
  /// Friction at a contact of the step's start.
  struct Rub {
    Index slot, other;
    bool is_part;
    double first_t, second_t;
    Vec3 normal, surface;  // the other's surface from its axis
    double load, yield;    // mN, mm
    Vec3 first_start, second_start;
    Vec3 expected;  // way in this step, as in the last one
  };
  /// Around a slot's segment.
  struct Ball {
    Vec3 middle;
    double radius;
  };
  struct RestPair {
    Index a, b;
    double excess;  // infinite: never in contact
  };

  void find_rest_pairs(const RodScene& scene);
  bool are_neighbours(const RodScene& scene, Index a, Index b, double most) const;
  double rest_excess(Index a, Index b) const;
  void set_radii(const RodScene& scene);
  void limit_radii(const RodScene& scene, std::vector<double>& wanted);
  void find_pairs(const RodScene& scene, const std::vector<Vec3>& ways, double slack);
  double least_slack() const;
  double slack_of(Index slot) const;
  bool covers(const std::vector<Vec3>& positions, const std::vector<Vec3>& points) const;
  double cover_trial(const RodScene& scene);
  bool may_meet(Index a, Index b) const;
  double nearing(Index a, Index b) const;
  void set_balls(const std::vector<Vec3>& positions);
  double ball_gap(Index a, Index b) const;
  void note_gaps();
  void add_pair(const RodScene& scene, Index slot, Index other, bool is_part);
  double farthest(const std::vector<Vec3>& points) const;
  void expect(const RodScene& scene);
  void note_friction(const RodScene& scene);
  void expect_ways(const std::vector<Rub>& before);
  Nearest nearest_to(const RodScene& scene, const ContactCone& part) const;
  template <class Touch>
  void forget_parts(std::vector<Touch>& touches, Index first, Index last) const;

  ContactCone cone_of(Index slot, const std::vector<Vec3>& positions) const;
  ContactCone part_cone(Index part, const std::vector<Vec3>& points) const;
  ContactCone second_cone(const ContactPair& pair, const std::vector<Vec3>& positions,
                          const std::vector<Vec3>& points) const;
  ConeGap gap_of(const ContactPair& pair, const std::vector<Vec3>& positions, const std::vector<Vec3>& points) const;
  ConeGap gap_or_less(const ContactPair& pair, const std::vector<Vec3>& positions,
                      const std::vector<Vec3>& points) const;
  Vec3 on_slot(Index slot, double t, const std::vector<Vec3>& positions) const;
  Vec3 on_part(Index part, double t, const std::vector<Vec3>& points) const;
  struct PairMotion {
    ConeMotion first, second;
  };
  /// Two that would meet: the first may go no less than `way` relative to the second (of a part: relative to where it
  /// is now) along the direction, which points to the first.
  struct Stop {
    Index slot, other;
    bool is_part;
    double first_t, second_t;
    Vec3 direction;
    double stiffness, way;
  };
  double way_at(const Stop& stop, const std::vector<Vec3>& positions) const;
  void add_stop(const ContactPair& pair, double free, double part);
  static double deepest_part(const PairMotion& motion, double free);
  void press_stop(const Stop& stop);
  PairMotion motion_of(const ContactPair& pair) const;
  double free_part_of(const ContactPair& pair) const;
  Vec3 surface_way(const Rub& rub, State state) const;
  Vec3 slipped(const Rub& rub, const std::vector<Vec3>& positions, State state) const;
  SegmentLoad& load(Index slot);
  void press(Index slot, double t, const Mat3& stiffness, const Vec3& gradient);
  void add_contacts(double part);
  void add_friction(double part);
  void add_jaws(double part);
  double friction_energy(const std::vector<Vec3>& positions, State state) const;
  double jaw_energy(const std::vector<Vec3>& positions, State state) const;
  static void push_instrument(Instrument& instrument, const Vec3& at, const Vec3& force_mN);
  double act_on_instruments();
  Index straightest_child(const RodScene& scene, Index slot) const;
  void slide(const RodScene& scene, Jaw& jaw);

  ContactOptions options_;
  std::vector<Index> parent_;
  std::vector<double> radius_, stiffness_, stop_stiffness_;  // by slot
  std::vector<Instrument> instruments_;
  std::vector<Part> parts_;
  Points points_;
  std::vector<Jaw> jaws_;
  std::vector<Vec3> jaw_trial_;
  std::vector<RestPair> rest_pairs_;

  std::vector<Vec3> present_, trial_, start_;
  SlotBoxes boxes_;
  std::vector<SlotBox> slot_boxes_;
  // Where pairs were found, and for which ways.
  std::vector<Vec3> found_at_, found_way_, points_found_at_, points_found_aim_;
  double found_ways_squared_ = 0;
  std::vector<double> slot_slack_;
  double slack_ = -1, last_way_ = 0, expected_way_ = 0;
  bool moves_ = false;
  std::vector<ContactPair> pairs_;
  std::vector<Ball> balls_;
  std::vector<Rub> rubs_;
  bool expects_ = false;  // nothing has moved yet in this step
  std::vector<Stop> stops_;
  bool loads_changed_ = false;
  std::vector<Index> near_slots_;

  std::vector<SegmentLoad> loads_;
  std::vector<Index> load_of_slot_, loaded_slots_;
  std::vector<VesselLink> links_;
};

}  // namespace vmesh

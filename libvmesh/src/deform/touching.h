#pragma once

#include <memory>
#include <vector>

#include "vmesh/centerline/cut.h"

#include "deform/implicit_rods.h"
#include "deform/slot_origin.h"
#include "deform/surroundings.h"

namespace vmesh {

/// What a simulation's vessels touch. Costs nothing until there is something. Throws InvalidInput for what does not
/// exist or is out of range, and with the paper's integrator, which knows no contact.
class Touching {
 public:
  Touching(const Centerline& centerline, RodScene& scene, ImplicitRods& rods);

  /// Goes on where another one is, after a cut. The neighbourhoods of the two new ends never touch each other, as they
  /// did not before.
  void carry_on(const Touching& before, const CenterlineCut& cut, const std::vector<SlotOrigin>& origin);

  void set_contact(const ContactOptions& options);
  Index add_instrument(const InstrumentShape& shape, const InstrumentPose& pose);
  double room_for(const InstrumentShape& shape, const InstrumentPose& pose) const;
  void remove_instrument(Index instrument);
  void move_instrument(Index instrument, const InstrumentPose& pose);
  Index grasp(Index segment, double t, double slips_N);
  void move_jaw(Index jaw, const Vec3& position_mm);
  void open_jaw(Index jaw);
  void set_tissue(Index segment, const TissueProperties& tissue);

  InstrumentPose instrument_pose(Index instrument) const;
  Vec3 jaw_position(Index jaw) const;
  HandForce drag_force(Index slot) const;
  HandForce instrument_force(Index instrument) const;
  HandForce jaw_force(Index jaw) const;
  std::size_t torn() const { return around_ ? around_->tissue.torn : 0; }
  double energy_J() const;
  double smallest_gap_mm() const { return around_ ? around_->smallest_gap() : HUGE_VAL; }

 private:
  Surroundings& around();
  void require_instrument(Index number) const;
  Index slot_of(Index segment) const;
  const Jaw& jaw(Index number) const;
  TissueSpring spring_of(Index slot) const;
  bool is_torn(Index slot) const;
  void put_jaw(const Touching& before, const CenterlineCut& cut, Jaw& jaw) const;
  void carry_tissue(const Touching& before, const CenterlineCut& cut, const std::vector<SlotOrigin>& origin);

  RodScene& scene_;
  ImplicitRods& rods_;
  std::vector<char> backwards_;           // by segment: from its node b to a in the tree
  std::vector<TissueProperties> tissue_;  // by segment
  std::unique_ptr<Surroundings> around_;
};

}  // namespace vmesh

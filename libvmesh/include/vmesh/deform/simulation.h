#pragma once

#include <memory>
#include <vector>

#include "vmesh/centerline/cut.h"
#include "vmesh/deform/contact.h"
#include "vmesh/deform/material.h"
#include "vmesh/deform/rod_tree.h"

namespace vmesh {

/// implicit: implicit Euler on the energy of the paper's springs, stable at any stiffness and step. paper: the explicit
/// procedure of the paper's section 3, Eqs. 3 to 8, in as many equal substeps as its springs need.
enum class Integrator { implicit, paper };

/// Variants of the paper's procedure. Its defaults are the paper as printed.
struct PaperProcedure {
  /// printed: Eqs. 4, 5 and 8: z becomes the mean of itself and the segment's direction, and the node is moved to where
  /// z points. spring: both as a stiff spring, which also acts on the segment's other end.
  enum class Coupling { printed, spring };
  /// printed: Eqs. 6 and 7, which keep z. polar: the rotation nearest to the three axes together.
  enum class Axes { printed, polar };

  Coupling coupling = Coupling::printed;
  Axes axes = Axes::printed;
  /// Substeps per step; 0: as many as the stiffest spring and the lightest node require.
  int substeps = 0;
};

struct SimulationOptions {
  Integrator integrator = Integrator::implicit;
  double step_s = 0.02;  ///< > 0
  int iterations = 2;    ///< implicit: Gauss-Newton iterations per step, at least 1
  Vec3 gravity_mm_s2 = Vec3::Zero();
  double drag_per_s = 0;             ///< decay rate of velocities; >= 0
  double squeeze_response_s = 0.02;  ///< time constant with which a profile follows a squeeze; >= 0
  /// implicit: a slot that moves by less than this (in local radii) and rotates by less (in radians) in each of
  /// rest_steps steps is at rest until something moves it farther. 0: nothing ever rests.
  double rest_tolerance = 1e-7;
  int rest_steps = 10;  ///< 1 to 100
  PaperProcedure paper{};
};

/// What happened in a step.
struct StepReport {
  int iterations = 0;      ///< Gauss-Newton iterations, or substeps
  int rejections = 0;      ///< Gauss-Newton updates, or parts of them, rejected for raising the energy
  double work_J = 0;       ///< by forces, gravity and, implicit, dragged nodes, instruments and jaws
  double movement_mm = 0;  ///< largest movement of a node in the last iteration: a measure of convergence
  std::size_t awake = 0;   ///< slots that are not at rest
};

/// A centerline that moves under forces: masses at nodes, springs along segments, damped angular springs between
/// neighbouring segments (section 3), on trees; loops are closed by springs that hold their ends together but let them
/// rotate. Lengths in mm, time in s, forces in N. A force, torque or squeeze stays until it is set again.
/// Deterministic; runs on one thread.
class CenterlineSimulation {
 public:
  /// `properties`: one per segment. Throws InvalidInput for properties or options out of range.
  CenterlineSimulation(const Centerline& centerline, const std::vector<SegmentProperties>& properties,
                       const SimulationOptions& options = {});
  ~CenterlineSimulation();
  CenterlineSimulation(CenterlineSimulation&&) noexcept;
  CenterlineSimulation& operator=(CenterlineSimulation&&) noexcept;

  /// The following functions throw InvalidInput for a node that does not exist and for numbers that are not finite.
  void fix(Index node);      ///< holds its position; it may rotate
  void clamp(Index node);    ///< holds position and frame
  void release(Index node);  ///< undoes fix(), clamp() and drag()
  /// The next step moves the node there; then it is fixed (a clamped one stays clamped).
  void drag(Index node, const Vec3& position_mm);
  void set_force(Index node, const Vec3& force_N);
  void set_torque(Index node, const Vec3& torque_N_mm);
  /// Sets the scale of the profile at a node, > 0, before squeezing.
  void set_radial_scale(Index node, double scale);
  /// Presses evenly on the wall around a node; negative forces widen it. Spread over the nearer halves of the node's
  /// segments.
  void set_squeeze(Index node, double force_N);
  void set_velocity(Index node, const Vec3& velocity_mm_s);
  void set_gravity(const Vec3& gravity_mm_s2);

  /// Parts a vessel; `cut` is of the centerline that moves, which becomes cut.centerline. Everything keeps its
  /// position, orientation, velocity, loads and holds; masses and springs of the segment cut are divided, its new ends
  /// are free. Momentum is kept, and energy does not grow, but for a loop: where the springs that closed it held its
  /// ends together, they are one now, and resist bending. Throws InvalidInput for a node that is held or loaded, and
  /// for a cut of another centerline.
  void cut(const CenterlineCut& cut);
  /// Puts a node on a segment in the same way; everything goes on as it was, but that the segment can bend there.
  void divide(const InsertedNode& node);

  /// The following are for Integrator::implicit and throw InvalidInput with the other. Without them, nothing touches
  /// anything, and nothing is spent on it.
  void set_contact(const ContactOptions& options);
  /// Instruments and vessels never overlap at the end of a step; one that starts within a vessel is refused. The
  /// vessel's surface is that of its round cones with the profile's radii.
  Index add_instrument(const InstrumentShape& shape, const InstrumentPose& pose);
  /// The gap between an instrument and the nearest vessel, were it added there: 0 or less if it would be refused.
  double room_for_instrument_mm(const InstrumentShape& shape, const InstrumentPose& pose) const;
  /// Takes it away; the others keep their numbers, and this one has none any more.
  void remove_instrument(Index instrument);
  /// The next step moves it there, as far as there is room: HandForce::behind_mm.
  void move_instrument(Index instrument, const InstrumentPose& pose);
  InstrumentPose instrument_pose(Index instrument) const;
  /// Jaws close on a segment at `t` in [0, 1] from its node a. Above `slips_N` the vessel slips through them, until
  /// they lose it at its end or sideways.
  Index grasp(Index segment, double t, double slips_N = std::numeric_limits<double>::infinity());
  void move_jaw(Index jaw, const Vec3& position_mm);
  void open_jaw(Index jaw);
  Vec3 jaw_position(Index jaw) const;
  /// Springs along a segment to where it rests; sets torn ones again.
  void set_tissue(Index segment, const TissueProperties& tissue);
  std::size_t torn() const;  ///< nodes whose tissue tore

  /// Of the last step, what pulls at the hand that drags (or fixes) a node; zero for the paper's integrator.
  HandForce drag_force(Index node) const;
  HandForce instrument_force(Index instrument) const;
  HandForce jaw_force(Index jaw) const;
  /// In barriers of contacts, jaws and tissue.
  double contact_energy_J() const;
  /// Of what is near each other; infinite if nothing is. Never 0 or less.
  double smallest_gap_mm() const;

  /// Advances by SimulationOptions::step_s. Allocates nothing without contact. Returns at once when everything is at
  /// rest.
  StepReport step() noexcept;

  const RodTree& tree() const;
  const Pose& pose() const;
  Vec3 position(Index node) const;
  /// Kinetic and elastic energy, computed on each call.
  double kinetic_energy_J() const;
  double elastic_energy_J() const;

  /// Slots that moved since the last clear_moved(), 1 or 0 each: what SurfaceBinding::apply() must update.
  const std::vector<char>& moved() const;
  void clear_moved();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vmesh

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simulation/step/simulation.hpp"

namespace irdm {

// What a step did, as plain numbers that can be handed to other languages as they are. Quaternions
// are w, x, y, z.

/// One stylus in one step, as in StylusRecord.
struct StylusRow {
  std::int32_t present = 0;
  std::int32_t contact = 0;  ///< ContactState
  std::int32_t object = -1;
  std::int32_t tool = -1;
  std::array<double, 3> tip{};     ///< [m], W
  std::array<double, 3> proxy{};   ///< [m], W
  std::array<double, 3> force{};   ///< on the stylus [N], W
  std::array<double, 3> torque{};  ///< on the stylus about the tip [N m], W
};

/// One object at the end of one step, as in ObjectStep.
struct ObjectRow {
  std::int32_t asleep = 0;
  std::int32_t solved = 1;
  std::array<double, 3> position{};          ///< of the centre of mass [m], W
  std::array<double, 4> orientation{};       ///< B to W
  std::array<double, 3> velocity{};          ///< [m/s], W
  std::array<double, 3> angular_velocity{};  ///< [rad/s], W
  double residual = 0.0;                     ///< of the contact problem [m]
  double energy = 0.0;                       ///< SoftObject::energy() [J]
};

StylusRow row_of(const StylusRecord& stylus) noexcept;
ObjectRow row_of(const ObjectStep& object, double energy) noexcept;

/// What exerts a contact force on an object.
enum class ContactKind : std::int32_t {
  kStylus = 0,
  kFloor = 1,
  kObject = 2,
  kScenery = 3,
  kCoupling = 4,  ///< a stylus that leads the object as its tool
};

/// One force on one object in one step. All vectors in W. What is not known of a contact is NaN.
struct ContactRow {
  using Numbers = std::array<double, 3>;

  std::int32_t object = 0;  ///< on which it acts
  std::int32_t kind = 0;    ///< ContactKind
  std::int32_t other = 0;   ///< stylus, object or scenery; 0 of the floor
  /// Sample of the object (ContactSampling) that touches an object, scenery or the ball of a
  /// stylus; surface node on the floor; -1 for the other tips of styluses.
  std::int32_t place = -1;
  std::int32_t state = 0;  ///< ContactState
  std::int32_t slipping = 0;
  /// Where it acts [m]: half-way through the step where bodies touch each other, else at its end.
  /// Of the floor without the elastic displacement along the floor.
  Numbers position{};
  Numbers normal{};   ///< of the contact, towards the object; of styluses into the object; unit
  Numbers force{};    ///< on the object [N]
  Numbers slip{};     ///< of the object along the other in the step [m]; known between bodies
  double area = 0.0;  ///< of the patch [m^2]; known between bodies
};

/// All forces of a step: what styluses, floor, scenery and other objects did to every object. A
/// contact between two objects is there twice, once for each. The sum of an object's forces and its
/// weight is the change of its momentum over dt, where it has neither damping nor tether.
class ContactRows {
 public:
  explicit ContactRows(const SimulationConfig& config);

  /// Of the step that the simulation made last. Real-time safe. Valid until the next call.
  /// @param record of that step
  std::span<const ContactRow> of(const Simulation& simulation, const StepRecord& record) noexcept;

 private:
  void add_styluses(const Simulation& simulation, const StepRecord& record) noexcept;
  void add_floor(const Simulation& simulation, const StepRecord& record) noexcept;
  void add_bodies(const StepRecord& record) noexcept;

  std::optional<FloorConfig> floor_;
  std::size_t scenery_count_;
  std::vector<ContactRow> forces_;
};

}  // namespace irdm

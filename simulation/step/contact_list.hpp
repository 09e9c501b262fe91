#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "simulation/step/simulation.hpp"

namespace irdm {

/// What exerts a contact force on an object.
enum class ContactKind : std::int32_t {
  kStylus = 0,
  kFloor = 1,
  kObject = 2,
  kScenery = 3,
  kCoupling = 4,  ///< a stylus that leads the object as its tool
};

/// One force on one object in one step. Plain numbers, so that it can be handed to other languages
/// as it is. All vectors in W. What is not known of a contact is NaN.
struct ContactForce {
  using Numbers = std::array<double, 3>;

  std::int32_t object = 0;  ///< on which it acts
  std::int32_t kind = 0;    ///< ContactKind
  std::int32_t other = 0;   ///< stylus, object or scenery; 0 of the floor
  /// Patch of the object (ContactSampling) that touches an object or scenery, surface node on the
  /// floor; -1 of a stylus.
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
class ContactList {
 public:
  explicit ContactList(const SimulationConfig& config);

  /// Of the step that the simulation made last. Real-time safe. Valid until the next call.
  /// @param record of that step
  std::span<const ContactForce> of(const Simulation& simulation, const StepRecord& record) noexcept;

 private:
  void add_styluses(const Simulation& simulation, const StepRecord& record) noexcept;
  void add_floor(const Simulation& simulation, const StepRecord& record) noexcept;
  void add_bodies(const StepRecord& record) noexcept;

  std::optional<FloorConfig> floor_;
  std::vector<ContactForce> forces_;
};

}  // namespace irdm

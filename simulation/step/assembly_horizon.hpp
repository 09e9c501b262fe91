#pragma once

#include <array>
#include <span>

#include "common/contact/contact_model.hpp"
#include "common/contact/contact_problem.hpp"
#include "simulation/contact/contact_patch.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// Another contact in the model of a contact of the same object: it is not frozen at its force, but
/// goes on obeying its law while its tip goes on (docs/theory.md). What its force then changes by
/// moves the place of the model's contact: by itself, which is added to the path, and per force of
/// that contact, which is added to the response: the Schur complement of its compliance, over the
/// horizon. Components in B where nothing else is said. Real-time safe; one thread.
class AssemblyHorizon {
 public:
  struct Contact {
    ContactPatch patch;
    ContactLaw law = ContactLaw::kHeld;
    Friction friction;
    Vector3 normal = Vector3::Zero();    ///< outward, of a touching one
    Vector3 place = Vector3::Zero();     ///< where the tip feels it, object at rest [m]
    Vector3 tip = Vector3::Zero();       ///< in the last step [m], W
    Vector3 velocity = Vector3::Zero();  ///< of the tip, dying away as it goes on [m/s], W
    Vector3 force = Vector3::Zero();     ///< that the model's path and forces have of it [N]
    double series = 0.0;                 ///< compliance of the coupling spring [m/N]
  };

  /// Lets the other contact answer in a model that is complete but for that.
  /// @param patch of the model's contact  @param force with which that one goes on, about [N]
  /// @param held all forces that the model's path has
  void answer(const Contact& other, ContactModel& model, const ContactPatch& patch,
              const Vector3& force, std::span<const NodalForce> held,
              ResponseEngine& engine) noexcept;

 private:
  using Path = std::array<Vector3, kMaxHorizon>;
  using Response = std::array<Matrix3, kMaxHorizon>;

  void find_compliance(const Contact& other, const ContactModel& model, const ContactPatch& patch,
                       std::span<const NodalForce> held, ResponseEngine& engine) noexcept;
  void find_changes(const Contact& other, const ContactModel& model, const Vector3& force) noexcept;
  void find_answers(const Contact& other, std::size_t steps) noexcept;

  Path path_;           ///< of the other one under the held forces
  Response own_;        ///< its compliance, rigid motion included
  Response shared_;     ///< of the model's contact per force on the other, the same
  Path change_;         ///< of its force [N]
  Response answer_;     ///< change of its force per force on the model's contact in the first step
  Matrix3 constraint_;  ///< projection on what it holds in the first step; open: zero
};

}  // namespace irdm

#pragma once

#include <cstdint>
#include <optional>

#include "common/contact/applied_forces.hpp"
#include "common/stylus.hpp"
#include "device_bridge/contact/contact_predictor.hpp"
#include "device_bridge/contact/step_pacer.hpp"

namespace irdm {

/// The contact of one stylus at the bridge, tick by tick: step pacer, contact predictor, and what
/// is told to the server of it. One session: make a new one for the next. Pure, real-time safe.
class BridgeContact {
 public:
  /// The force that the contact asks for, and what it rests on.
  struct ForceCommand {
    bool any = false;             ///< the rest means something
    bool paused = false;          ///< the run is paused: what was felt is to fade
    std::int64_t content_ns = 0;  ///< end of the last step that the server knew everything of
    std::int64_t horizon_ns = 0;  ///< how long after that it is good
    double energy = 0.0;          ///< that the device may give [J], W
    std::int64_t solved_ns = 0;   ///< when it was solved, with the tip of then
    ContactState contact = ContactState::kFree;
    Vector3 force = Vector3::Zero();   ///< on the stylus [N], W
    Vector3 normal = Vector3::Zero();  ///< outward, of the surface; unit, W; zero: not known
  };

  /// @param dt of the server's step [s]  @param tick_ns between two calls of tick()
  BridgeContact(double dt, std::int64_t tick_ns) noexcept;

  /// @param model has passed check()
  void receive(const ContactModel& model, std::int64_t now_ns) noexcept;

  /// Ends the steps that are due, with the tip where it is now [m], W, finite. True: there is news
  /// in applied(), once shown() was told.
  bool tick(std::int64_t now_ns, const Vector3& tip) noexcept;
  /// After tick(): the device shows this in place of wanted().force, and in the steps that ended
  /// the object gets what of it a contact can exert.
  /// @param force on the stylus [N], W
  void shown(const Vector3& force) noexcept;

  const ForceCommand& wanted() const noexcept { return wanted_; }
  /// Of the last steps.
  const AppliedForces& applied() const noexcept { return applied_; }
  /// By how many steps it is ahead of the newest model; 0 without one.
  std::uint64_t lookahead() const noexcept;
  /// Steps in contact that no model reached: their force faded.
  std::uint64_t withheld() const noexcept { return withheld_; }

 private:
  void solve(std::uint64_t k, std::int64_t now_ns, const Vector3& tip) noexcept;
  void remember(std::uint64_t k, const Vector3& tip) noexcept;
  double energy_left() const noexcept;

  StepPacer pacer_;
  double dt_;
  ContactPredictor predictor_;
  std::uint64_t newest_model_ = 0;  ///< step of the newest model; while the pacer runs
  std::int64_t horizon_ns_ = 0;     ///< of that model
  double energy_ = 0.0;             ///< of that model [J] ...
  std::uint64_t known_ = 0;         ///< ... with the hand's work until the end of this step
  ForceCommand wanted_;
  int steps_a_tick_;         ///< at least 1
  int ended_ = 0;            ///< steps that were solved in the last tick
  bool in_contact_ = false;  ///< in the last step that anything is known of
  std::uint64_t withheld_ = 0;
  AppliedForces applied_;
  AppliedHistory history_;           ///< of what was in applied_
  std::optional<Vector3> last_tip_;  ///< at the end of the last step; none: it begins anew
};

}  // namespace irdm

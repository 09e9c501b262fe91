#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/contact/contact_model.hpp"
#include "common/contact/persistent_contact.hpp"

namespace irdm {

/// The contact of one stylus, solved at the bridge from what the server sent: it goes on with the
/// rigid motion from the newest model's state, under the forces that the server did not know of
/// yet, and solves in each step the contact problem that the server would solve
/// (docs/theory.md), with u the model's free path, R its response and f_i
/// those forces in B:
///
///     (R_0 + rigid + series) f_k = Q^T (x - c) - place - u_k - sum_i R_{k-i} f_i
///
/// for what is held or sticks; a touching contact only pushes, inside its friction cone. During
/// steps of which nothing is known the object may come anywhere about the tip: a contact of before
/// then comes back softly, and is whole after kReturn. Pure, real-time safe, one thread.
/// Large: what it knows of a contact has a meaning on the newest model only, so every piece needs
/// that.
class ContactPredictor {
 public:
  static constexpr double kReturn = 0.5;  ///< [s]

  struct Answer {
    /// False: there is no model that reaches this step; a contact goes on as after hold().
    bool known = false;
    Vector3 force = Vector3::Zero();  ///< on the object [N], W; of step k
    ContactState state = ContactState::kFree;
    Vector3 normal = Vector3::Zero();  ///< outward, of the surface; W
  };

  /// Takes a newer model; one that is not newer is left aside.
  /// @param model has passed check()
  void receive(const ContactModel& model) noexcept;

  /// The force of step k, from the tip at its end. Steps come in order, each at most once.
  /// @param tip [m], W, finite
  Answer solve(std::uint64_t k, const Vector3& tip) noexcept;

  /// The force that was answered for a step [N], W; zero when that is too long ago.
  Vector3 applied(std::uint64_t step) const noexcept;
  /// Where it acted, from the centre of mass [m], B.
  Vector3 arm(std::uint64_t step) const noexcept;

  /// In place of solve(): in step k the device went on showing what it showed in the step before.
  /// The way of the tip in it is left to the next solve().
  void hold(std::uint64_t k) noexcept;

  /// What the device shows in place of the force that was answered for the last step, or one just
  /// before it. The object gets what of that a contact can exert: a touching one pushes within the
  /// friction cone, an open one does nothing. Before the next solve().
  /// @param force on the object [N], W
  void show(std::uint64_t step, const Vector3& force) noexcept;

  /// Forgets everything.
  void reset() noexcept { *this = ContactPredictor{}; }

 private:
  /// What was done in one step.
  struct Past {
    std::uint64_t step = ~std::uint64_t{0};
    Vector3 force = Vector3::Zero();              ///< on the object [N], W
    Vector3 force_B = Vector3::Zero();            ///< as the newest model's motion has it
    Vector3 arm = Vector3::Zero();                ///< [m], B
    Vector3 slip = Vector3::Zero();               ///< [m], B
    Quaternion halfway = Quaternion::Identity();  ///< B to W, half-way through the step
    ContactState contact = ContactState::kFree;
  };
  static constexpr std::size_t kKept = 64;

  Past& past(std::uint64_t step) noexcept { return past_[step % kKept]; }
  const Past& past(std::uint64_t step) const noexcept { return past_[step % kKept]; }
  bool reaches(std::uint64_t k) const noexcept;
  bool missing(std::uint64_t step) const noexcept;
  void start_motion() noexcept;
  void move_to(std::uint64_t k) noexcept;
  Vector3 surface_at(std::uint64_t k) const noexcept;
  void place_anew() noexcept;
  double share(std::uint64_t k) noexcept;
  bool touch(std::uint64_t k, const Vector3& from_surface, double way) noexcept;
  void end_contact() noexcept;

  bool any_ = false;  ///< model_ means something
  ContactModel model_;
  std::optional<RigidBody> body_;  ///< of the model; while it is valid
  RigidState motion_;              ///< at the end of step moved_to_
  std::uint64_t moved_to_ = 0;
  std::array<Past, kKept> past_{};
  // The contact as it is here: a touching one may have begun, slipped or ended since the model.
  PersistentContact contact_;
  ContactDisplacement displacement_;  ///< of its place
  std::uint64_t began_ = 0;           ///< touching in this step
  Vector3 offset_ = Vector3::Zero();  ///< from the model's place to ours, along the surface [m], B
  std::uint64_t last_step_ = 0;
  bool silent_ = true;                 ///< nothing was known of the last step
  std::optional<std::uint64_t> back_;  ///< the step since which a contact comes back from a silence
  std::optional<Vector3> last_tip_;    ///< W
  Vector3 last_place_ = Vector3::Zero();  ///< of a touching contact, object at rest [m]
};

}  // namespace irdm

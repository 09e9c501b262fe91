#pragma once

#include <vector>

#include "common/contact/contact_problem.hpp"
#include "simulation/contact/patch_compliance.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// Contacts of one object with another object, with scenery, with the ball of a stylus, or with
/// other parts of itself. They persist from step to step. Each contact is at a sample of the object
/// (ContactSampling). Real-time safe after construction, unless a function says otherwise; for one
/// thread.
class ContactPair {
 public:
  /// One contact of the current step.
  struct Contact {
    int sample = 0;
    PatchCompliance::Place place;         ///< on the object
    PatchCompliance::Place other_place;   ///< on the other object; count 0 on scenery
    Vector3 arm = Vector3::Zero();        ///< position of the sample without forces [m], B
    Vector3 other_arm = Vector3::Zero();  ///< its target [m], B of the other object
    Vector3 gap = Vector3::Zero();        ///< from the sample to its target [m], W
    Vector3 normal = Vector3::Zero();     ///< outward unit normal of the other surface, W
  };

  /// @param object number of the object
  /// @param other as BodyContactRecord::other
  ContactPair(int object, int other) : object_(object), other_(other) {}
  virtual ~ContactPair() = default;

  /// Sets the largest number of contacts in a step, which is 0 before. Not real-time safe.
  void set_most(int most) { found_.resize(static_cast<std::size_t>(most)); }
  virtual void reset() noexcept = 0;
  /// Saves or restores the state (StateArchive). Not real-time safe.
  virtual void archive(StateArchive& state) = 0;

  /// Selects the contacts of this step: samples that would be inside the other surface at the end
  /// of the step, and samples that were pressed in the last step. If there are more than set_most()
  /// allows, pressed samples come first, then the deepest. Returns their number.
  virtual int find() noexcept = 0;
  /// Writes contact i of this step as a constraint on the object, in W.
  virtual void pose(int i, const Friction& friction,
                    ContactConstraint& constraint) const noexcept = 0;
  /// Takes the solution of constraint i: moves the friction anchor by the slip and keeps the force
  /// for the next warm start.
  /// @param yielded part of the gap that the solution leaves open [m], W
  virtual void update(int i, const ContactConstraint& solved, const Vector3& yielded) noexcept = 0;
  /// Handles contact i if its contact problem had no solution, so that no force acted in this step.
  virtual void skip(int i) noexcept = 0;
  /// Writes the record of contact i, without its position, which the caller knows from the motion.
  virtual void write(int i, const ContactConstraint& solved,
                     BodyContactRecord& record) const noexcept = 0;

  /// Returns whether all contacts of the pair share one friction force (ContactLaw::kGroupFriction)
  /// and are without friction of their own.
  virtual bool shares_friction() const noexcept { return false; }
  /// Returns the weight of contact i of this step in the shared friction: the force that pressed it
  /// in the last step [N].
  virtual double friction_weight(int /*i*/) const noexcept { return 0.0; }
  /// Writes the shared friction of this step as a constraint, but for its gap and its group, in W.
  virtual void pose_friction(const Friction& /*friction*/,
                             ContactConstraint& /*constraint*/) const noexcept {}
  /// Takes the solution of that constraint. Called before update().
  virtual void take_friction(const ContactConstraint& /*solved*/) noexcept {}

  /// Returns whether the two bodies may touch in this step. True for an object and itself.
  virtual bool near() const noexcept = 0;
  /// Returns whether the other body is moving scenery or the ball of a stylus that is present.
  virtual bool driven() const noexcept = 0;
  /// Returns the largest depth of the object inside the other body in their initial poses [m]; 0
  /// for an object and itself.
  virtual double initial_depth() noexcept = 0;

  /// Sets the compliance of the spring by which a stylus leads the other body [m/N], 0 before. All
  /// contacts with that body share it.
  void set_spring_compliance(double compliance) noexcept { spring_compliance_ = compliance; }
  double spring_compliance() const noexcept { return spring_compliance_; }
  int count() const noexcept { return count_; }
  const Contact& contact(int i) const noexcept { return found_[static_cast<std::size_t>(i)]; }
  int object() const noexcept { return object_; }
  int other() const noexcept { return other_; }

 protected:
  /// Samples whose rest position is farther than this from the other body are skipped: kLeastReach
  /// [m] plus kReachFactor times the largest displacement seen lately, which fades by kReachFading
  /// in each step.
  static constexpr double kLeastReach = 2e-3;
  static constexpr double kReachFactor = 2.0;
  static constexpr double kReachFading = 0.99;
  /// Ratio of the displacement by static contacts to its bound, at most.
  static constexpr double kBoundShare = 0.25;
  /// Time constant with which a sample comes out that was inside when its contact began, and with
  /// which a yielding sample returns to its anchor [s].
  static constexpr double kInsetTime = 0.05;

  static Vector3 sideways(const Vector3& v, const Vector3& normal) noexcept {
    return v - v.dot(normal) * normal;
  }

  struct Candidate {
    int sample;
    bool pressed;
    double depth;  ///< [m]
    Vector3 place;
  };
  /// Reduces the candidates to the largest number of contacts and sorts them by their samples.
  void choose(std::vector<Candidate>& candidates) const noexcept;

  std::vector<Contact> found_;
  int count_ = 0;

 private:
  int object_;
  int other_;
  double spring_compliance_ = 0.0;
};

}  // namespace irdm

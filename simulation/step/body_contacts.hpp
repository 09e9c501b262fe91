#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "common/contact/contact_problem.hpp"
#include "common/contact/persistent_contact.hpp"
#include "common/motion/free_motion.hpp"
#include "simulation/collision/deformed_surface.hpp"
#include "simulation/collision/scenery.hpp"
#include "simulation/contact/contact_sampling.hpp"
#include "simulation/contact/patch_compliance.hpp"
#include "simulation/contact/self_contact.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// What the contacts of an object with other bodies need of it: its shape, and the step under way.
struct ContactBody {
  const ContactSampling& sampling;
  const RestSurface& rest;
  DeformedSurface& surface;
  const FreeMotion& motion;
};

/// The contacts of one object's samples with another object, with scenery, or with other parts of
/// the same object, from step to step.
/// Each is a touching contact whose "tip" is an anchor on the other's surface: where the sample
/// came down, moved along as far as it slips. A sample begins to touch where its way in the step,
/// begun somewhat inside its own object, crosses the other's surface from outside: fast ones do not
/// pass through. Real-time safe after construction; one thread.
class BodyContacts {
 public:
  /// A contact of this step.
  struct Contact {
    int sample = 0;
    PatchCompliance::Place place;         ///< of the object
    PatchCompliance::Place other_place;   ///< of the other; count 0: scenery
    Vector3 arm = Vector3::Zero();        ///< of the sample without force [m], B of the object
    Vector3 other_arm = Vector3::Zero();  ///< of where it is wanted [m], B of the other
    Vector3 gap = Vector3::Zero();        ///< from the sample to where it is wanted [m], W
    Vector3 normal = Vector3::Zero();     ///< outward of the other, unit, W
  };

  /// @param object, other are the numbers of objects; both bodies must outlive this
  /// @param first_sample those before it are left to others
  BodyContacts(int object, const ContactBody& body, int other, const ContactBody& other_body,
               double dt, int first_sample = 0);
  /// @param scenery its number  @param there must outlive this
  BodyContacts(int object, const ContactBody& body, int scenery, const SceneryStep& there,
               double dt);
  /// Of an object with itself. @param reach of the body's samples; must outlive this
  BodyContacts(int object, const ContactBody& body, const SelfReach& reach, double dt);

  /// It can have at most so many contacts in a step; before: none. Not real-time safe.
  void set_most(int most) { found_.resize(static_cast<std::size_t>(most)); }
  void reset() noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state) {
    if (self_) self_->archive(state);
    state.values(samples_);
    for (double* length : {&closed_, &displaced_}) state.value(*length);
    for (std::uint64_t* step : {&step_, &clear_}) state.value(*step);
    state.value(any_pressed_);
    if (state.reading()) count_ = 0;
  }

  /// Chooses this step's contacts: samples that would be inside the other by the end of it, and
  /// those that were pressed on it; at most as many as it can have, those that were pressed and
  /// then the deepest first. Returns how many.
  int find() noexcept;
  /// Writes contact i of the step as a constraint on the object, in W.
  void pose(int i, const Friction& friction, ContactConstraint& constraint) const noexcept;
  /// After the solution of its constraint: the anchor slips, the force is kept for the next start.
  /// @param yielded from where it is to where it was wanted [m], W
  void update(int i, const ContactConstraint& solved, const Vector3& yielded) noexcept;
  /// What became of contact i. Its position is left to the caller, who knows the motion.
  void write(int i, const ContactConstraint& solved, BodyContactRecord& record) const noexcept;

  /// Whether both may touch in the step under way; an object and itself: always.
  bool near() const noexcept;
  /// Whether it is with scenery that moves.
  bool driven() const noexcept { return scenery_ != nullptr && scenery_->moves(); }

  int count() const noexcept { return count_; }
  const Contact& contact(int i) const noexcept { return found_[static_cast<std::size_t>(i)]; }
  int object() const noexcept { return object_; }
  /// The other object, or the same; -1 - i: scenery i.
  int other() const noexcept { return other_; }

  /// The largest depth of a sample inside the other as both stand at the start [m], 0: none, or the
  /// other is the object itself.
  double initial_depth() noexcept;

 private:
  /// A sample's way in the step, B of the other or W: it is looked for from somewhat inside its own
  /// object to a little beyond its end.
  struct Way {
    Vector3 start, end;  ///< [m]
    Vector3 outward;     ///< of the sample, unit
    Vector3 from, to;    ///< [m]
    Vector3 middle() const noexcept { return 0.5 * (from + to); }
    double length() const noexcept { return (to - from).norm(); }
  };
  /// How far from the other the middle of a way was: as long as all have moved by less, nothing has
  /// crossed the way.
  struct Sighting {
    double distance = 0.0;             ///< [m]; 0: not known
    Vector3 place = Vector3::Zero();   ///< of the sample, displaced [m], B of the object
    Vector3 middle = Vector3::Zero();  ///< of its way [m]
    DeformedSurface::Mark own, other;
    double displaced = 0.0;  ///< how far surfaces were seen away from rest there [m]
    bool outside = false;
  };
  struct Sample {
    PersistentContact contact;
    SurfaceLocation anchor;              ///< on the other, at rest
    Vector3 offset = Vector3::Zero();    ///< from it to the anchor [m], B of the other
    Vector3 anchor_W = Vector3::Zero();  ///< on scenery [m]
    Vector3 normal = Vector3::Zero();    ///< outward of the other, unit, B of the other or W
    /// How deep below the anchor it is wanted [m]: where it was inside already when the contact
    /// began (pushed out at once it would get twice that depth a step as its speed), less what it
    /// yields, so that it comes to its anchor.
    double inset = 0.0;
    double flat_inset = 0.0;  ///< what flat_inset() adds to it [m]
    /// The last step in which it was outside or among the contacts; 0: none.
    std::uint64_t clear = 0;
    std::uint64_t pressed = 0;  ///< the last step in which a force acted on it; 0: none
    /// Whose distance from the other at rest was computed last [m], B of the other or W.
    Vector3 looked_at = Vector3::Zero();
    double distance = 0.0;            ///< that [m]; of the inside of an object 0
    int nearest = 0;                  ///< triangle of the other that was nearest to it
    Vector3 force = Vector3::Zero();  ///< of the last step [N], B of the object
    Sighting seen;

    /// It was seen outside in this step: what comes from there has no inset.
    void mark_outside(std::uint64_t step) noexcept {
      clear = step;
      inset = 0.0;
    }
  };

  /// Surfaces touch where their outward normals point at each other: cosine of their angle at most.
  static constexpr double kFacing = -0.3;

  static Vector3 sideways(const Vector3& v, const Vector3& normal) noexcept {
    return v - v.dot(normal) * normal;
  }
  bool near_itself() noexcept;
  double unseen() noexcept;
  bool beyond(const Vector3& x, double reach, Sample& state) const noexcept;
  double look(const Vector3& place, Sample& state) const noexcept;
  Vector3 started(const Vector3& place) const noexcept;
  Vector3 displaced_place(const ContactSampling::Sample& sample) noexcept;
  Vector3 other_displacement(const SurfaceLocation& at) noexcept;
  Way way_of(int sample, const Vector3& place) const noexcept;
  bool is_clear(int sample, const Sighting& seen) noexcept;
  void note(const Way& way, const Vector3& place, double distance, double displaced,
            Sample& state) const noexcept;
  bool begin(int sample, const Vector3& place, Sample& state) noexcept;
  bool begin_on_scenery(int sample, const Vector3& place, const Way& way, Sample& state) noexcept;
  std::optional<Vector3> normal_at(int sample, const Vector3& outward,
                                   const SurfaceLocation& at) const noexcept;
  double flat_inset(int sample, const Vector3& normal) const noexcept;
  double inset_of(double depth, const Sample& state) const noexcept;
  void keep_anchor(const Sample& before, const Vector3& place, Sample& state) noexcept;
  void describe(int sample, const Vector3& place, Contact& contact) noexcept;

  int object_;
  int other_;
  ContactBody body_;
  const ContactBody* other_body_ = nullptr;
  const SceneryStep* scenery_ = nullptr;
  std::optional<SelfSearch> self_;  ///< the other is the object itself
  double radius_ = 0.0;  ///< of a ball about the centre of mass that has the surface at rest [m]
  double other_radius_ = 0.0;
  Eigen::AlignedBox3d other_box_;  ///< of its surface at rest, B
  double inset_left_;              ///< share of an inset that is left after a step
  double depth_;                   ///< that a sample's way begins inside its object [m]
  double closed_ = 0.0;            ///< how deep samples were before forces closed it [m]
  double displaced_ = 0.0;         ///< how far surfaces were seen away from rest [m]
  int first_sample_ = 0;
  std::vector<Sample> samples_;
  struct Candidate {
    int sample;
    bool pressed;
    double depth;  ///< [m]
    Vector3 place;
  };
  std::vector<Candidate> candidates_;
  std::vector<Contact> found_;
  int count_ = 0;
  std::uint64_t step_ = 1;
  std::uint64_t clear_ = 0;  ///< the last step in which no part of the object was near another
  bool any_pressed_ = false;
};

}  // namespace irdm

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "common/contact/persistent_contact.hpp"
#include "simulation/collision/scenery.hpp"
#include "simulation/contact/self_contact.hpp"
#include "simulation/step/contact_body.hpp"
#include "simulation/step/contact_pair.hpp"

namespace irdm {

/// The contacts of one object's samples with another object, with scenery, or with other parts of
/// the same object, from step to step.
/// Each is a touching contact whose "tip" is an anchor on the other's surface: where the sample
/// came down, moved along as far as it slips. A sample begins to touch where its way in the step,
/// begun somewhat inside its own object, crosses the other's surface from outside: fast ones do not
/// pass through. Real-time safe after construction; one thread.
class BodyContacts final : public ContactPair {
 public:
  /// @param object, other are the numbers of objects; both bodies must outlive this
  /// @param first_sample those before it are left to others
  BodyContacts(int object, const ContactBody& body, int other, const ContactBody& other_body,
               double dt, int first_sample = 0);
  /// @param other scenery or the ball of a stylus, as BodyContactRecord::other
  /// @param there the same; it must outlive this object
  BodyContacts(int object, const ContactBody& body, int other, const SceneryStep& there, double dt);
  /// Of an object with itself. @param reach of the body's samples; must outlive this
  BodyContacts(int object, const ContactBody& body, const SelfReach& reach, double dt);

  void reset() noexcept override;
  void archive(StateArchive& state) override {
    if (self_) self_->archive(state);
    state.values(samples_);
    for (double* length : {&closed_, &displaced_}) state.value(*length);
    for (std::uint64_t* step : {&step_, &clear_}) state.value(*step);
    state.value(any_pressed_);
    if (state.reading()) count_ = 0;
  }
  int find() noexcept override;
  void pose(int i, const Friction& friction, ContactConstraint& constraint) const noexcept override;
  void update(int i, const ContactConstraint& solved, const Vector3& yielded) noexcept override;
  void skip(int i) noexcept override { update(i, {}, Vector3::Zero()); }
  void write(int i, const ContactConstraint& solved,
             BodyContactRecord& record) const noexcept override;

  bool near() const noexcept override;
  bool driven() const noexcept override { return scenery_ != nullptr && scenery_->moves(); }
  double initial_depth() noexcept override;

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
  std::vector<Candidate> candidates_;
  std::uint64_t step_ = 1;
  std::uint64_t clear_ = 0;  ///< the last step in which no part of the object was near another
  bool any_pressed_ = false;
};

}  // namespace irdm

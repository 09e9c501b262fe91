#pragma once

#include <vector>

#include "common/contact/persistent_contact.hpp"
#include "simulation/collision/scenery.hpp"
#include "simulation/step/contact_body.hpp"
#include "simulation/step/contact_pair.hpp"

namespace irdm {

/// Contacts of a soft object with a ball of the scenery or of a stylus, on the samples for its
/// radius (ContactSampling::ball()).
///
/// The position of a sample and whether it faces the ball are evaluated in the *reference state*:
/// the state of the object at the end of the step if the ball's forces stayed as they were in the
/// last step, near field included. Without these forces a soft surface springs back through the
/// ball within one step, and its geometry is meaningless. With them one geometric pass per step is
/// enough (docs/theory.md, "Balls against soft bodies").
class BallContacts final : public ContactPair {
 public:
  /// @param ball number of the ball, as BodyContactRecord::other
  /// @param there the ball; it and `compliance` must outlive this object
  BallContacts(int object, const ContactBody& body, const PatchCompliance& compliance, int ball,
               const SceneryStep& there, double dt);

  void reset() noexcept override;
  void archive(StateArchive& state) override;
  int find() noexcept override;
  void pose(int i, const Friction& friction, ContactConstraint& constraint) const noexcept override;
  void update(int i, const ContactConstraint& solved, const Vector3& yielded) noexcept override;
  void skip(int i) noexcept override;
  void write(int i, const ContactConstraint& solved,
             BodyContactRecord& record) const noexcept override;
  bool shares_friction() const noexcept override { return true; }
  double friction_weight(int i) const noexcept override;
  void pose_friction(const Friction& friction,
                     ContactConstraint& constraint) const noexcept override;
  void take_friction(const ContactConstraint& solved) noexcept override;
  bool near() const noexcept override;
  bool driven() const noexcept override { return scenery_.moves(); }
  double initial_depth() noexcept override;

 private:
  struct Sample {
    Vector3 anchor = Vector3::Zero();  ///< point of the ball that friction ties it to [m], W
    Vector3 normal = Vector3::Zero();  ///< outward unit normal of the ball in this step, W
    Vector3 force = Vector3::Zero();   ///< of the last step [N], B
    double push = 0.0;                 ///< its part along the ball's normal, without friction [N]
    /// Target depth below the ball's surface [m]. It is positive at first if the sample was inside
    /// before it faced the ball, and decays, so that the sample comes out gradually.
    double inset = 0.0;
    Vector3 gap = Vector3::Zero();  ///< ContactPair::Contact::gap of this step [m], W
    double depth = 0.0;             ///< below the ball's surface in the reference state [m]
    std::uint64_t looked = 0;       ///< last step in which `depth` was evaluated
    std::uint64_t listed = 0;       ///< last step in which it was a candidate
    std::uint64_t updated = 0;      ///< last step in which it was part of a solved contact problem
    std::uint64_t pressed = 0;      ///< last step in which a force acted on it
    // The last evaluation of its position without forces.
    bool seen = false;
    double distance = 0.0;                ///< from the ball's surface [m]
    Vector3 seen_from = Vector3::Zero();  ///< the ball's centre [m], B
    double displaced = 0.0;               ///< distance from its rest position [m]
    DeformedSurface::Mark mark;
  };
  /// A sample that is close to the ball in this step.
  struct Near {
    int sample;
    Vector3 place;  ///< its position without forces [m], B
  };

  /// The ball's way in this step, relative to the object.
  struct BallWay {
    Vector3 before;  ///< centre at the start [m], B
    Vector3 centre;  ///< centre at the end [m], B
    double way;      ///< length [m]
  };
  /// Samples of one face of an element.
  struct Face {
    int first = 0;
    int count = 0;
    Vector3 middle = Vector3::Zero();  ///< centroid of the samples at rest [m], B
    double radius = 0.0;               ///< of the sphere about it that contains the samples [m]
  };

  const BallSample& shape(int i) const noexcept {
    return body_.sampling.ball_samples()[static_cast<std::size_t>(range_.first + i)];
  }
  int number_of(const Contact& contact) const noexcept {
    return contact.sample - body_.sampling.first_ball() - range_.first;
  }
  bool is_pressed(const Sample& state) const noexcept { return state.pressed + 1 == step_; }
  Vector3 displaced_place(const BallSample& shape) noexcept;
  void make_faces();
  void collect_near(const BallWay& ball) noexcept;
  void look_at(int sample, const Vector3& centre, double limit) noexcept;
  bool may_be_near(int sample, const Vector3& centre, double reach, double limit) noexcept;
  void collect_forces() noexcept;
  const Vector3& shift_of(int node) noexcept;
  Vector3 mesh_shift(const BallSample& shape) noexcept;
  double near_field_shift(int sample) const noexcept;
  Vector3 reference_normal(const BallSample& shape) noexcept;
  bool evaluate(const Near& near, const BallWay& ball, Candidate& candidate) noexcept;
  Vector3 contact_normal(const Vector3& place, const Vector3& face,
                         const BallWay& ball) const noexcept;
  void keep_left_out() noexcept;
  void forget_steps() noexcept;

  ContactBody body_;
  const PatchCompliance& compliance_;
  const SceneryStep& scenery_;
  ContactSampling::BallRange range_;
  double radius_;           ///< of the ball [m]
  double body_radius_;      ///< bounding radius of the object at rest [m]
  double inset_left_;       ///< share of an inset that is left after a step
  double displaced_ = 0.0;  ///< largest displacement of a sample seen lately [m]
  std::uint64_t step_ = 1;
  Vector3 friction_ = Vector3::Zero();  ///< shared, of the last step [N], B
  bool slipping_ = false;               ///< in the last step
  std::vector<Sample> samples_;
  std::vector<int> used_;  ///< samples that were ever evaluated since the last reset
  std::vector<Face> faces_;
  // Working memory of find().
  std::vector<Near> near_;
  std::vector<Candidate> candidates_;
  std::vector<int> pressed_;               ///< samples with a force in the last step
  std::vector<int> pressed_now_;           ///< samples with a force in this step, sorted
  std::vector<int> loaded_;                ///< nodes that the last step's forces load
  std::vector<Vector3> load_;              ///< their load, indexed by node [N], B
  std::vector<std::uint64_t> loaded_in_;   ///< step of each entry of load_
  std::vector<std::uint64_t> shifted_in_;  ///< step of each entry of shift_
  std::vector<Vector3> shift_;             ///< displacement of each node by `load_` [m], B
};

}  // namespace irdm

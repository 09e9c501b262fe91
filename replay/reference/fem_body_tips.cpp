// Held points of a FemBody that follow their tips.
#include "common/error.hpp"
#include "replay/reference/fem_body.hpp"

namespace irdm::replay {
namespace {

// How far a point may miss its tip, as an acceleration: over a step's length squared [m/s^2]. The
// force that a miss costs grows so with shorter steps.
constexpr double kMiss = 2.5e-4;
constexpr double kTrialForce = 1e-3;  // [N]

}  // namespace

// While the hold is given up, and where a tip merely touches, the recorded force acts.
bool FemBody::follows(const ContactRecord& contact, const StylusRecord& stylus) const {
  return follow_tips_ && contact.state == ContactState::kHeld && stylus.present &&
         (stylus.buttons & kGrabButton) != 0;
}

void FemBody::choose_followed(const ObjectRecord& recorded,
                              std::span<const StylusRecord> styluses) {
  const std::vector<Followed> before = std::move(followed_);
  followed_.clear();
  for (std::size_t s = 0; s < styluses.size(); ++s) {
    if (!follows(recorded.contact[s], styluses[s])) continue;
    Followed& followed =
        followed_.emplace_back(Followed{s, styluses[s].tip, spring_compliance_[s], {}});
    masks_[s].spread(recorded.contact[s].point, followed.patch);
  }
  const bool same =
      std::equal(before.begin(), before.end(), followed_.begin(), followed_.end(),
                 [](const Followed& a, const Followed& b) { return a.stylus == b.stylus; });
  if (same) return;
  tip_forces_.forget();
  last_forces_.clear();
}

// Where each tip is away from where its point and its coupling spring take it [m], W.
Eigen::VectorXd FemBody::misses(const ObjectRecord& moved) const {
  const Quaternion Q(rigid_motion().rotation);
  Eigen::VectorXd misses(3 * static_cast<Eigen::Index>(followed_.size()));
  for (std::size_t i = 0; i < followed_.size(); ++i) {
    const Followed& followed = followed_[i];
    const ContactRecord& contact = moved.contact[followed.stylus];
    const Vector3 force = moved.halfway * contact.force;
    misses.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        followed.tip - place(followed.patch) - Q * contact.offset - followed.compliance * force;
  }
  return misses;
}

// The forces, constant during the step as the server's, that take the points to their tips by its
// end; in the record they stand in B as the recorded ones do.
void FemBody::follow(ObjectRecord& recorded) {
  const precompute::BodyState before = state_;
  const double largest_speed = workspace_.largest_speed;
  const auto missed = [&](const Eigen::VectorXd& forces) {
    put_forces(forces, recorded);
    state_ = before;
    workspace_.largest_speed = largest_speed;
    move(recorded);
    return misses(recorded);
  };
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(followed_.size()));
  if (!last_forces_.empty()) forces = last_forces_[0];
  if (last_forces_.size() > 1) forces += last_forces_[0] - last_forces_[1];
  if (!tip_forces_.solve(missed, forces, kMiss * model_->dt * model_->dt, kTrialForce)) {
    throw Error("--reference fem", "a held point cannot follow its tip",
                "use smaller sub-steps, or --from forces");
  }
  remember_forces(forces);
}

void FemBody::put_forces(const Eigen::VectorXd& forces, ObjectRecord& recorded) const {
  for (std::size_t i = 0; i < followed_.size(); ++i) {
    recorded.contact[followed_[i].stylus].force =
        recorded.halfway.conjugate() * Vector3(forces.segment<3>(3 * static_cast<Eigen::Index>(i)));
  }
}

void FemBody::remember_forces(const Eigen::VectorXd& forces) {
  last_forces_.insert(last_forces_.begin(), forces);
  if (last_forces_.size() > 2) last_forces_.pop_back();
}

}  // namespace irdm::replay

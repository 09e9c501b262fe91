#include "simulation/step/floor_contacts.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "common/response/stored_response.hpp"

namespace irdm {
namespace {

// Nodes as near as this are given to the solver, which leaves them alone unless they come down.
constexpr double kNearFloor = 1e-4;
// How far a node may be from where it would be at rest, to be looked at: at least so far [m], and
// so many times as far as any was seen. What was seen fades by this factor a step: a node rings on.
constexpr double kLeastMargin = 2e-3;
constexpr double kMarginFactor = 2.0;
constexpr double kFading = 0.99;
// A body that does not yield is where it should be at the end of a step with the speed mirrored: it
// goes on bouncing between steps. Yielding at each contact by this many dt^2 / M takes the speed
// up. At rest it sinks in by this many g dt^2 over the number of contacts.
constexpr double kRigidSoftness = 4.0;

}  // namespace

FloorContacts::FloorContacts(const FloorConfig& floor, const RestSurface& rest, const Model& model)
    : floor_(floor),
      rest_(rest),
      anchors_(static_cast<std::size_t>(rest.node_count())),
      nodes_(kMaxFloorContacts),
      posed_(kMaxFloorContacts) {
  if (rest.node_count() > kMaxNodes) {
    throw Error("floor",
                "an object with " + std::to_string(rest.node_count()) +
                    " surface nodes is too large for a floor",
                "use a mesh of at most " + std::to_string(kMaxNodes) + " surface nodes");
  }
  compliance_ = stored_response(model)->zero_lag();
  if (is_rigid(model)) softness_ = kRigidSoftness * model.dt * model.dt / model.body.mass;
}

void FloorContacts::reset() noexcept {
  std::fill(anchors_.begin(), anchors_.end(), FloorAnchor{});
  count_ = 0;
  posed_count_ = 0;
  displaced_ = 0.0;
}

int FloorContacts::find(const FreeMotion& motion, DeformedSurface& surface,
                        double displaced) noexcept {
  count_ = 0;
  displaced_ = std::max(kFading * displaced_, displaced);
  const double margin = kLeastMargin + kMarginFactor * displaced_;
  const Vector3 up = motion.orientation.conjugate() * floor_.normal;
  const double offset = height(motion.position);
  for (int i = 0; i < rest_.node_count() && count_ < kMaxFloorContacts; ++i) {
    FloorAnchor& anchor = anchors_[static_cast<std::size_t>(i)];
    if (!anchor.contact.any() && offset + up.dot(rest_.node(i)) > margin) continue;
    const Vector3& r = surface.node(i);
    displaced_ = std::max(displaced_, (r - rest_.node(i)).norm());
    if (!anchor.contact.any() && offset + up.dot(r) > kNearFloor) continue;
    if (!anchor.contact.any()) {
      const Vector3 x = motion.to_world(r);
      anchor.position = x - height(x) * floor_.normal;
    }
    nodes_[static_cast<std::size_t>(count_++)] = i;
  }
  if (count_ == 0) posed_count_ = 0;  // the contacts of styluses take the rows
  return count_;
}

void FloorContacts::pose(const FreeMotion& motion, DeformedSurface& surface,
                         ContactProblem& problem) noexcept {
  const auto m = static_cast<std::size_t>(count_);
  const bool same =
      count_ == posed_count_ && std::equal(nodes_.begin(), nodes_.begin() + count_, posed_.begin());
  for (std::size_t a = 0; a < m; ++a) {
    const int i = nodes_[a];
    const FloorAnchor& anchor = anchors_[static_cast<std::size_t>(i)];
    ContactConstraint& unknown = problem.contact(static_cast<int>(a));
    anchor.contact.pose(-(motion.orientation.conjugate() * floor_.normal), floor_.friction,
                        surface.node(i), motion.to_body(anchor.position), unknown);
    unknown.force = anchor.force;
    if (same) continue;
    for (std::size_t b = 0; b < m; ++b) {
      problem.elastic(static_cast<int>(a), static_cast<int>(b)) =
          compliance_.block<3, 3>(3 * i, 3 * nodes_[b]);
    }
    problem.elastic(static_cast<int>(a), static_cast<int>(a)).diagonal().array() += softness_;
  }
  posed_count_ = count_;
  std::copy_n(nodes_.begin(), m, posed_.begin());
}

Matrix3 FloorContacts::between(const ContactPatch& patch, int i) const noexcept {
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(patch.count); ++k) {
    sum += patch.weights[k] * compliance_.block<3, 3>(3 * patch.nodes[k], 3 * node(i));
  }
  return sum;
}

void FloorContacts::update_contacts(const FreeMotion& motion,
                                    const ContactProblem& problem) noexcept {
  for (int a = 0; a < count_; ++a) {
    const ContactConstraint& solved = problem.contact(a);
    FloorAnchor& anchor = anchors_[static_cast<std::size_t>(node(a))];
    const bool pressed = solved.mode != ContactMode::kOpen;
    const bool slipping = solved.mode == ContactMode::kSlipping;
    anchor.contact.begin(pressed ? ContactState::kTouching : ContactState::kFree, slipping);
    anchor.force = solved.force;
    const Vector3 moved = solved.arm + problem.elastic(a, a) * solved.force - rest_.node(node(a));
    displaced_ = std::max(displaced_, moved.norm());
    if (!slipping) continue;
    anchor.position -= motion.orientation * solved.slip;
    anchor.position -= height(anchor.position) * floor_.normal;
  }
}

}  // namespace irdm

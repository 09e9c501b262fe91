#include "ros_bridge/stylus_topics.hpp"

#include <spdlog/spdlog.h>

#include <cmath>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"

namespace irdm::ros {
namespace {

constexpr double kNormTolerance = 0.01;  // of quaternions in single precision, and more

Quaternion normalised(const geometry_msgs_msg_dds__Quaternion_& q) noexcept {
  const Quaternion given(q.w, q.x, q.y, q.z);
  return std::abs(given.norm() - 1.0) <= kNormTolerance ? given.normalized() : given;
}

}  // namespace

StylusTopics::StylusTopics(const Participant& participant, const std::string& frame_id,
                           const StylusSettings& settings, const StylusClient::Meanwhile& meanwhile)
    : frame_id_(frame_id),
      client_(settings, meanwhile),
      number_(client_.number()),
      name_("stylus_" + std::to_string(number_)),
      command_(
          participant.reader(geometry_msgs_msg_dds__PoseStamped__desc, name_ + "/command", false)),
      grab_(participant.reader(std_msgs_msg_dds__Bool__desc, name_ + "/grab", true)),
      wrench_(participant.writer(geometry_msgs_msg_dds__WrenchStamped__desc, name_ + "/wrench")),
      tip_(participant.writer(geometry_msgs_msg_dds__PoseStamped__desc, name_ + "/pose")),
      orientation_(Quaternion::Identity()) {
  spdlog::info("{}: poses are awaited on {}", name_, participant.full_name(name_ + "/command"));
}

void StylusTopics::relay() {
  grab_.take<BoolMessage>(
      [this](const BoolMessage& message) { buttons_ = message.data ? kGrabButton : 0u; });
  command_.take<PoseMessage>([this](const PoseMessage& message) { take(message); });
  const StylusFeedback now = client_.get();
  const WrenchMessage wrench =
      wrench_message(header(frame_id_, now.time_ns), now.force, now.torque);
  wrench_.write(&wrench);
  if (now.ready != ready_) report(now.ready);
}

void StylusTopics::take(const PoseMessage& message) {
  const std::string frame = message.header.frame_id;
  if (!frame.empty() && frame != frame_id_) {
    return ignore("its frame is " + in_quotes(frame) + ", not " + in_quotes(frame_id_));
  }
  const auto& p = message.pose.position;
  const StylusPose pose{.tip = Vector3(p.x, p.y, p.z),
                        .orientation = normalised(message.pose.orientation),
                        .buttons = buttons_};
  if (const char* fault = client_.fault_of(pose)) return ignore(fault);
  ignored_for_.clear();
  client_.set(pose);
  orientation_.put(ros_to_world() * pose.orientation);
}

void StylusTopics::ignore(const std::string& why) {
  if (why != ignored_for_) spdlog::warn("{}: a pose is ignored: {}", name_, why);
  ignored_for_ = why;
}

void StylusTopics::report(bool ready) {
  ready_ = ready;
  spdlog::info("{}: {}", name_, client_.state());
}

void StylusTopics::publish_tip(const StylusRecord& stylus) {
  if (!stylus.present) return;
  orientation_.receive();
  const bool touches = stylus.contact != ContactState::kFree;
  const PoseMessage message = pose_message(
      header(frame_id_, monotonic_ns()), touches ? stylus.proxy : stylus.tip, orientation_.front());
  tip_.write(&message);
}

}  // namespace irdm::ros

#pragma once

#include <string>

#include "common/realtime/triple_buffer.hpp"
#include "device_bridge/stylus_client.hpp"
#include "ros_bridge/dds.hpp"
#include "ros_bridge/messages.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm::ros {

/// A stylus of a server that ROS nodes lead: poses of its tip come in, the force at the hand goes
/// out. A pose counts for StylusSettings::stale_after; without one there is no force.
class StylusTopics {
 public:
  /// Connects to the server; throws Error, and what `meanwhile` throws.
  /// @param frame_id of all messages
  StylusTopics(const Participant& participant, const std::string& frame_id,
               const StylusSettings& settings, const StylusClient::Meanwhile& meanwhile);

  /// Takes what has come and publishes the newest force. One thread.
  void relay();
  /// Publishes where the tip is shown: where the surface holds it, or where it was led to. Another
  /// thread.
  void publish_tip(const StylusRecord& stylus);
  int number() const noexcept { return number_; }  ///< in the scene

 private:
  void take(const PoseMessage& message);
  void ignore(const std::string& why);
  void report(bool ready);

  const std::string frame_id_;
  StylusClient client_;
  const int number_;
  const std::string name_;  ///< of the topics
  Endpoint command_;
  Endpoint grab_;
  Endpoint wrench_;
  Endpoint tip_;
  std::uint32_t buttons_ = 0;
  bool ready_ = false;
  std::string ignored_for_;               ///< the last pose; empty: it was not ignored
  TripleBuffer<Quaternion> orientation_;  ///< as commanded, to W; from relay() to publish_tip()
};

}  // namespace irdm::ros

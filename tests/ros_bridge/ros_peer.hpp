#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace irdm::test {

using Numbers3 = std::array<double, 3>;

struct RosWrench {
  Numbers3 force{};
  Numbers3 torque{};
  std::string frame_id;
};

struct RosPose {
  Numbers3 position{};
  std::array<double, 4> orientation{};  ///< x y z w
  std::string frame_id;
};

struct RosCloud {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t point_step = 0;
  std::vector<std::string> fields;
  std::vector<std::uint8_t> data;
};

/// What a node of ROS 2 would be to the bridge: topics of stylus 0 and object 0, through one stack
/// of DDS, on the loopback interface.
class RosPeer {
 public:
  virtual ~RosPeer() = default;
  virtual void send_pose(const RosPose& pose) = 0;
  virtual void send_grab(bool down) = 0;
  // The next message that has come; nothing: there is none.
  virtual std::optional<RosWrench> wrench() = 0;
  virtual std::optional<RosPose> tip() = 0;
  virtual std::optional<RosPose> body() = 0;
  virtual std::optional<RosCloud> points() = 0;
};

/// @param name_space of the bridge
std::unique_ptr<RosPeer> make_cyclone_peer(std::uint32_t domain, const std::string& name_space);
std::unique_ptr<RosPeer> make_fast_peer(std::uint32_t domain, const std::string& name_space);

/// Configuration of Cyclone DDS: the loopback interface, no multicast.
inline constexpr const char* kLoopbackOnly =
    "<General><Interfaces><NetworkInterface name=\"lo\" multicast=\"false\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<Peers><Peer Address=\"127.0.0.1\"/></Peers></Discovery>";

}  // namespace irdm::test

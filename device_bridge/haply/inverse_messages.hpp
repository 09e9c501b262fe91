#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "common/geometry.hpp"

/// The part of the Inverse Service's WebSocket messages that the bridge uses, versions 3.0 to 3.5,
/// as docs.haply.co/inverseSDK has them: JSON, m, N; axes +x right, +y away from the person, +z up.
/// Here everything is in D: +x right, +y up, +z towards the person. Pure.
namespace irdm::haply {

/// The vector of a force is called `values` before 3.5, `vector` from then on.
enum class ForceKey { kValues, kVector };

/// What the service says of a device beside its state.
struct InverseStatus {
  bool calibrated = false;
  bool ready = false;
  bool power_supply = true;  ///< told of late; not told: it is there
  bool in_use = false;       ///< somebody commands it
};

/// A device in a message. Empty: this message does not say.
struct InverseDevice {
  std::string id;
  std::string type = {};
  std::string handedness = {};
  std::optional<bool> gravity_compensation = {};
  std::optional<InverseStatus> status = {};
  std::optional<Vector3> tip = {};  ///< [m], D; finite
};

/// A grip in a message: it knows its orientation and its buttons.
struct VerseGrip {
  std::string id;
  std::optional<Quaternion> orientation = {};  ///< in D, norm 1
  std::uint32_t buttons = 0;                   ///< a, b, c: bits 0 to 2
};

struct ServiceMessage {
  bool session = false;  ///< it numbers its sessions, which services before 3.5 do not
  std::vector<InverseDevice> devices = {};
  std::vector<VerseGrip> grips = {};
};

/// A message that is none of the service's; in words why.
class MessageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws MessageError.
ServiceMessage decode(std::string_view text);

/// Commands a force, and asks for the state by that.
/// @param force [N], D; what is not finite is none
std::string encode_force(const std::string& device, const Vector3& force, ForceKey key);
/// The same without force as the first message of a connection to 3.5: with a name for the
/// session, and the axes that the bridge counts on.
std::string encode_first(const std::string& device);
/// Asks for all devices with their configuration, and commands none.
std::string encode_full_state();

/// Turns gravity compensation on, as a body of POST. @param key tells the version, too
std::string encode_gravity(const std::string& device, ForceKey key);
/// `project_version` in an answer of /version: 3.5 is {3, 5}; none when it is no such answer.
struct ServiceVersion {
  int major = 0;
  int minor = 0;
};
std::optional<ServiceVersion> decode_version(std::string_view text);

}  // namespace irdm::haply

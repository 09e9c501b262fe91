#include "device_bridge/haply/inverse_opening.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "common/error.hpp"
#include "device_bridge/haply/http_request.hpp"

namespace irdm::haply {
namespace {

std::string names(const std::vector<InverseDevice>& devices) {
  std::string all;
  for (const InverseDevice& device : devices) all += (all.empty() ? "" : ", ") + device.id;
  return all.empty() ? "none" : all;
}

OpenedDevice choose(const ServiceMessage& inventory, const std::string& wanted) {
  for (const InverseDevice& device : inventory.devices) {
    if (device.id.empty() || (!wanted.empty() && device.id != wanted)) continue;
    if (auto claim = DeviceClaim::lay(device.id)) return {device, std::move(*claim)};
    if (wanted.empty()) continue;
    throw Error(label_of(wanted), "is open already", "give each [[device]] a name of its own");
  }
  throw Error(
      label_of(wanted),
      "the service has no such device, or it is open already; found: " + names(inventory.devices),
      "check power and cable, and give the id that Haply Hub shows as name");
}

// The service gives each connection a session of its own and lets them coexist; what it makes of
// two that send forces to one device its documents do not say.
void refuse_in_use(const InverseDevice& device) {
  if (!device.status || !device.status->in_use) return;
  throw Error(label_of(device.id), "another session of the service commands it",
              "end the other program (Haply Hub shows the sessions), or set `shared = true` if it "
              "sends no forces");
}

std::optional<ServiceVersion> ask_version(const InverseSettings& settings,
                                          const boost::asio::ip::address& at) {
  const auto answer = http_request(at, settings.service, boost::beast::http::verb::get, "/version");
  return answer ? decode_version(*answer) : std::nullopt;
}

}  // namespace

std::string label_of(const std::string& device) {
  return device.empty() ? "first Haply device" : "Haply device " + device;
}

OpenedDevice open_device(const ServiceMessage& inventory, const InverseSettings& settings,
                         const boost::asio::ip::address& at) {
  OpenedDevice opened = choose(inventory, settings.device);
  const InverseDevice& device = opened.device;
  if (!settings.shared) refuse_in_use(device);
  const auto version = ask_version(settings, at);
  if (version && version->major != 3) {
    throw Error(label_of(device.id),
                "the service's version " + std::to_string(version->major) + "." +
                    std::to_string(version->minor) + " is not known",
                "use an Inverse Service 3.x");
  }
  const bool new_words = version ? version->minor >= 5 : inventory.session;
  opened.key = new_words ? ForceKey::kVector : ForceKey::kValues;
  if (!device.gravity_compensation.value_or(false)) {
    turn_gravity_on(device.id, opened.key, settings, at);
  }
  const std::string hand = device.handedness.empty() ? "" : ", " + device.handedness + "-handed";
  spdlog::info("{}: {}{}, Inverse Service {}", label_of(device.id),
               device.type.empty() ? "inverse3" : device.type, hand,
               version ? "3." + std::to_string(version->minor) : "of unknown version");
  return opened;
}

// 3.5 has it below the device, on the same port; before, it is on the port of the HTTP service.
void turn_gravity_on(const std::string& device, ForceKey key, const InverseSettings& settings,
                     const boost::asio::ip::address& at) {
  const bool new_words = key == ForceKey::kVector;
  ServerAddress address = settings.service;
  if (!new_words) address.port = settings.old_http_port;
  const std::string target =
      new_words ? "/inverse3/" + device + "/config/gravity_compensation" : "/gravity_compensation";
  if (http_request(at, address, boost::beast::http::verb::post, target,
                   encode_gravity(device, key))) {
    return;
  }
  spdlog::warn("{}: its gravity compensation is off; turn it on in Haply Hub", label_of(device));
}

}  // namespace irdm::haply

#pragma once

// Must come before Boost's own headers: it mends Boost 1.74 under C++20.
#include "common/wire/asio.hpp"

#include <cstdint>
#include <string>

#include "common/realtime/scheduling.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/haply/device_claim.hpp"
#include "device_bridge/haply/inverse_messages.hpp"

namespace irdm::haply {

/// What is opened, and where.
struct InverseSettings {
  ServerAddress service = {"localhost", 10001};
  std::uint16_t old_http_port = 10000;  ///< where services before 3.5 take settings
  std::uint16_t events_port = 10020;    ///< where services from 3.5 on tell events
  std::string device = {};  ///< its id; empty: the first that this process has not opened
  std::string grip = {};    ///< likewise; empty: the first in a message
  bool shared = false;      ///< another session of the service may command it, too
  RealTimeScheduling scheduling = RealTimeScheduling::kIgnore;
};

/// A device that was chosen and set up.
struct OpenedDevice {
  InverseDevice device;  ///< as the service told then
  DeviceClaim claim;
  ForceKey key = ForceKey::kValues;
};

/// Chooses a device in the first message of a connection, asks for the service's version and turns
/// gravity compensation on. Up to two seconds, for the service's HTTP. Throws Error when there is
/// no such device, it is open already or another session commands it, or the version is unknown.
/// @param at where the service is
OpenedDevice open_device(const ServiceMessage& inventory, const InverseSettings& settings,
                         const boost::asio::ip::address& at);

/// Up to a second. When it fails a warning is logged.
void turn_gravity_on(const std::string& device, ForceKey key, const InverseSettings& settings,
                     const boost::asio::ip::address& at);

/// In messages for a person. @param device its id; empty: not chosen yet
std::string label_of(const std::string& device);

/// The one of this id; null: none.
template <typename Thing>
const Thing* find_by_id(const std::vector<Thing>& things, const std::string& id) {
  for (const Thing& thing : things) {
    if (thing.id == id) return &thing;
  }
  return nullptr;
}

}  // namespace irdm::haply

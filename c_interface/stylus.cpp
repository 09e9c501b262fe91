#include <algorithm>

#include "c_interface/caller.hpp"
#include "c_interface/irdm.h"
#include "common/realtime/clock.hpp"
#include "device_bridge/stylus_client.hpp"

struct irdm_stylus_client {
  explicit irdm_stylus_client(const irdm::StylusSettings& settings) : client(settings) {}

  irdm::StylusClient client;
};

namespace {

// False where nobody is there, or where the client does not take it.
bool read_pose(const irdm::StylusClient& client, const irdm_command& command,
               irdm::StylusPose& pose) noexcept {
  pose.buttons = command.buttons;
  pose.tip = irdm::tip_of(command);
  pose.orientation = irdm::orientation_of(command);
  return command.present != 0 && client.fault_of(pose) == nullptr;
}

void write_feedback(const irdm::StylusFeedback& from, irdm_feedback& to) noexcept {
  to.ready = from.ready ? 1 : 0;
  to.contact = static_cast<std::int32_t>(from.contact);
  std::copy_n(from.force.data(), 3, to.force);
  std::copy_n(from.torque.data(), 3, to.torque);
  to.latency = from.latency;
  to.ticks = from.ticks;
  to.late_ticks = from.late_ticks;
  to.sessions = from.sessions;
  to.time = irdm::kNanosecond * static_cast<double>(from.time_ns);
}

}  // namespace

irdm_status irdm_stylus_connect(const char* address, const char* options,
                                irdm_stylus_client** client, char* message,
                                std::size_t message_size) {
  return irdm::open_handle(address, client, message, message_size, [&] {
    return irdm::read_stylus_settings(
        address, irdm::TomlTable::parse_text(options == nullptr ? "" : options, "options"));
  });
}

void irdm_stylus_close(irdm_stylus_client* client) {
  delete client;
}

irdm_status irdm_stylus_set(irdm_stylus_client* client, const irdm_command* command) {
  if (client == nullptr || command == nullptr || client->client.lockstep()) {
    return IRDM_BAD_ARGUMENT;
  }
  irdm::StylusPose pose;
  if (!read_pose(client->client, *command, pose)) return IRDM_BAD_ARGUMENT;
  client->client.set(pose);
  return IRDM_OK;
}

irdm_status irdm_stylus_get(irdm_stylus_client* client, irdm_feedback* feedback) {
  if (client == nullptr || feedback == nullptr) return IRDM_BAD_ARGUMENT;
  write_feedback(client->client.get(), *feedback);
  return IRDM_OK;
}

irdm_status irdm_stylus_step(irdm_stylus_client* client, const irdm_command* command,
                             irdm_feedback* feedback) {
  if (client == nullptr || command == nullptr || !client->client.lockstep()) {
    return IRDM_BAD_ARGUMENT;
  }
  irdm::StylusPose pose;
  if (!read_pose(client->client, *command, pose)) return IRDM_BAD_ARGUMENT;
  try {
    const irdm::StylusFeedback got = client->client.step(pose);
    if (feedback != nullptr) write_feedback(got, *feedback);
    return IRDM_OK;
  } catch (...) {
    return IRDM_FAILED;
  }
}

irdm_status irdm_stylus_state(irdm_stylus_client* client, char* text, std::size_t size) {
  if (client == nullptr || text == nullptr || size == 0) return IRDM_BAD_ARGUMENT;
  try {
    irdm::write_text(client->client.state(), text, size);
    return IRDM_OK;
  } catch (...) {
    return IRDM_FAILED;
  }
}

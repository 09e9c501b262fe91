#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "device_bridge/network_client.hpp"

/// What the doctor reads from the system: plain values, which tests make up. Reading may take a
/// second or two, and needs no rights.
namespace irdm::doctor {

/// Whether something may be had, and the system's words when not.
struct Permission {
  bool given = false;
  std::string refusal = {};
};

/// Of putting a thread under SCHED_FIFO as the servo loop is. Tried.
Permission try_real_time();

/// Of locking `bytes` of memory. Tried.
inline constexpr std::size_t kLockedBytes = std::size_t{64} << 20;
Permission try_locked_memory(std::size_t bytes = kLockedBytes);

struct ClockFacts {
  std::string source = {};             ///< the kernel's; empty: unknown
  std::int64_t resolution_ns = 0;      ///< of the monotonic clock
  std::int64_t usual_lateness_ns = 0;  ///< of waking up after a millisecond's sleep: median
  std::int64_t worst_lateness_ns = 0;
};

/// Sleeps a fifth of a second, by milliseconds.
/// @param root folder that stands for "/"
ClockFacts look_at_clock(const std::filesystem::path& root = "/");

struct ServerFacts {
  bool connects = false;  ///< somebody listens there
  bool welcomes = false;  ///< and is a server that takes these styluses
  std::string words = {};
};

/// Connects, says hello and goodbye; sends no sample, so that the run is not disturbed, and does
/// not offer lockstep, whose run would end with the goodbye.
ServerFacts ask_server(const ClientSettings& settings, std::size_t styluses);

}  // namespace irdm::doctor

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/realtime/histogram.hpp"
#include "common/wire/message.hpp"

namespace irdm {

/// What a bridge's network thread has done, over all sessions.
struct ClientReport {
  std::uint64_t sessions = 0;
  std::uint64_t forces = 0;        ///< received and taken
  std::uint64_t forces_old = 0;    ///< dropped: the last one again, or of before the session
  std::uint64_t gaps = 0;          ///< times that force steps are missing between two forces
  std::uint64_t steps_missed = 0;  ///< force steps missing in all gaps
  std::uint64_t longest_gap = 0;   ///< [steps]
  std::uint64_t samples = 0;       ///< given to a connection
  std::uint64_t protocol_errors = 0;
  std::uint64_t models = 0;          ///< contact models received and taken
  std::uint64_t models_refused = 0;  ///< contact models that could not be true
  std::uint64_t stalls = 0;  ///< connections closed because samples were not answered any more
  std::uint64_t datagram_sessions = 0;  ///< sessions whose stream went by datagrams
  std::uint64_t datagrams = 0;          ///< received, and the server's
  std::uint64_t datagrams_dropped = 0;  ///< received, and not, or for the second time
  Histogram round_trip;  ///< sample taken to its first force received [ns]; real time only
  Histogram jitter;      ///< how much a round trip differs from the one before [ns]
  std::optional<wire::Status> server_at_first;  ///< what the server said of its run, first
  std::optional<wire::Status> server;           ///< and last
  std::string failure;                          ///< why it gave up, one line; empty: it did not
};

}  // namespace irdm

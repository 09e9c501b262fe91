#pragma once

#include <cstdint>
#include <string>

#include "common/realtime/histogram.hpp"

namespace irdm::haply {

/// How long the service took to answer, and what went wrong.
struct InverseReport {
  std::uint64_t answers = 0;
  double sum = 0.0;           ///< from a message to its answer, of all [s]
  Histogram round_trip = {};  ///< the same [ns]
  std::uint64_t bad_messages = 0;
  std::uint64_t reconnects = 0;
};

/// In words.
std::string to_text(const InverseReport& report);

}  // namespace irdm::haply

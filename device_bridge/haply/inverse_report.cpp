#include "device_bridge/haply/inverse_report.hpp"

#include <array>
#include <cstdio>

namespace irdm::haply {

std::string to_text(const InverseReport& report) {
  const double mean = report.answers > 0 ? report.sum / static_cast<double>(report.answers) : 0.0;
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "%llu answers, round trip mean %.3f, p99 %.3f, max %.3f ms; %llu messages not "
                "understood, %llu reconnects",
                static_cast<unsigned long long>(report.answers), 1e3 * mean,
                1e-6 * static_cast<double>(report.round_trip.percentile(0.99)),
                1e-6 * static_cast<double>(report.round_trip.maximum()),
                static_cast<unsigned long long>(report.bad_messages),
                static_cast<unsigned long long>(report.reconnects));
  return text.data();
}

}  // namespace irdm::haply

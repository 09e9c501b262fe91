#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace irdm::wire {

/// Returns where a program that listens on an address of this machine can be reached, each as
/// ADDRESS:PORT or [IPV6]:PORT, one or more: the address itself, or, where it stands for all
/// (0.0.0.0 or ::), the loopback address first and then those of the network interfaces.
/// @param address numeric
std::vector<std::string> open_endpoints(const std::string& address, std::uint16_t port);

}  // namespace irdm::wire

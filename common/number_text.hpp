#pragma once

#include <cstddef>
#include <string>

namespace irdm {

/// For messages: a number as a stream prints it.
std::string number_text(double value);
/// HOST:PORT, with brackets around an address of IPv6.
std::string address_text(const std::string& host, int port);
/// "1 stylus", "2 styluses".
std::string styluses_text(std::size_t count);

}  // namespace irdm

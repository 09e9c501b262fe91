#include "common/number_text.hpp"

#include <sstream>

namespace irdm {

std::string number_text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

std::string address_text(const std::string& host, int port) {
  const bool ipv6 = host.find(':') != std::string::npos;
  return (ipv6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

std::string styluses_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " stylus" : " styluses");
}

}  // namespace irdm

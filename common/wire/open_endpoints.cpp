#include "common/wire/open_endpoints.hpp"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <sstream>

#include "common/wire/asio.hpp"

namespace irdm::wire {
namespace {

using boost::asio::ip::address;

// Link-local addresses are left out: another machine would need the name of its own interface.
void add(const sockaddr* from, bool v6_wanted, std::vector<address>& to) {
  if (from->sa_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, from, sizeof v4);
    to.emplace_back(boost::asio::ip::address_v4(ntohl(v4.sin_addr.s_addr)));
  } else if (from->sa_family == AF_INET6 && v6_wanted) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, from, sizeof v6);
    boost::asio::ip::address_v6::bytes_type bytes{};
    std::copy(std::begin(v6.sin6_addr.s6_addr), std::end(v6.sin6_addr.s6_addr), bytes.begin());
    const boost::asio::ip::address_v6 found(bytes);
    if (!found.is_link_local()) to.emplace_back(found);
  }
}

std::vector<address> of_interfaces(bool v6_wanted) {
  std::vector<address> found;
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return found;
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(list, &::freeifaddrs);
  for (const ifaddrs* each = list; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr != nullptr && (each->ifa_flags & IFF_UP) != 0) {
      add(each->ifa_addr, v6_wanted, found);
    }
  }
  return found;
}

}  // namespace

std::vector<std::string> open_endpoints(const std::string& text, std::uint16_t port) {
  const address wanted = boost::asio::ip::make_address(text);
  std::vector<address> open{wanted};
  if (wanted.is_unspecified()) {
    open = of_interfaces(wanted.is_v6());
    std::stable_partition(open.begin(), open.end(),
                          [](const address& each) { return each.is_loopback(); });
  }
  if (open.empty()) open.push_back(wanted);
  std::vector<std::string> endpoints;
  for (const address& each : open) {
    std::ostringstream out;
    out << boost::asio::ip::tcp::endpoint(each, port);
    endpoints.push_back(out.str());
  }
  return endpoints;
}

}  // namespace irdm::wire

#pragma once

// Must come before Boost's own headers: it mends Boost 1.74 under C++20.
#include "common/wire/asio.hpp"

#include <boost/beast/http/verb.hpp>
#include <optional>
#include <string>

#include "device_bridge/bridge_config.hpp"

namespace irdm::haply {

/// As in a URL and in a Host line.
std::string host_text(const ServerAddress& address);

/// One question by HTTP, on a connection of its own; waits for the answer, a second at most. None
/// when nobody answers, or not with 200.
/// @param at where the host was found before: no name is looked up, which could take longer
/// @param address its port, and the name for the Host line
/// @param body of a POST, JSON
std::optional<std::string> http_request(const boost::asio::ip::address& at,
                                        const ServerAddress& address, boost::beast::http::verb verb,
                                        const std::string& target, const std::string& body = "");

}  // namespace irdm::haply

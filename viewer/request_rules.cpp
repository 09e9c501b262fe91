#include "viewer/request_rules.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <string>

#include "common/wire/asio.hpp"

namespace irdm::viewer {
namespace {

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// Calls `test` with the items of a list with commas until it says true.
template <typename Test>
bool any_item(std::string_view list, Test test) {
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    if (test(trimmed(list.substr(0, comma)))) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

bool is_port(std::string_view text) {
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, port);
  return error == std::errc() && rest == end;
}

bool is_address(std::string_view text, bool v6) {
  if (text.find('%') != std::string_view::npos) return false;  // a zone is for this machine alone
  boost::system::error_code error;
  if (v6) {
    boost::asio::ip::make_address_v6(std::string(text), error);
  } else {
    boost::asio::ip::make_address_v4(std::string(text), error);
  }
  return !error;
}

/// A name of the net, an IPv4 address being one.
bool is_name(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '.' || c == '_';
  });
}

enum class HostKind { kNone, kNamed, kLocal };  ///< local: a numeric address or localhost

/// Of HOST, HOST:PORT, [IPV6] or [IPV6]:PORT and nothing else (RFC 9110, section 7.2, but that
/// user, escapes and addresses to come are not taken: no browser sends them). Boost.URL is not in
/// Boost 1.74, and Beast's own parser knows no hosts.
HostKind host_kind(std::string_view host) {
  const bool v6 = host.starts_with('[');
  const std::size_t bracket = v6 ? host.find(']') : 0;
  if (bracket == std::string_view::npos) return HostKind::kNone;
  const std::size_t end = std::min(host.find(':', bracket), host.size());
  if (end < host.size() && !is_port(host.substr(end + 1))) return HostKind::kNone;
  if (v6) {
    const bool address = end == bracket + 1 && is_address(host.substr(1, bracket - 1), true);
    return address ? HostKind::kLocal : HostKind::kNone;
  }
  const std::string_view name = host.substr(0, end);
  if (!is_name(name)) return HostKind::kNone;
  const bool local = is_address(name, false) || same_word(name, "localhost");
  return local ? HostKind::kLocal : HostKind::kNamed;
}

}  // namespace

bool origin_allowed(std::string_view origin, std::string_view host, bool token_needed) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!origin.starts_with(scheme)) continue;
    if (!same_word(origin.substr(scheme.size()), host)) return false;
    const HostKind kind = host_kind(host);
    return kind == HostKind::kLocal || (kind == HostKind::kNamed && token_needed);
  }
  return false;
}

bool same_token(std::string_view given, std::string_view wanted) {
  unsigned difference = given.size() == wanted.size() ? 0 : 1;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const char other = wanted.empty() ? '\0' : wanted[i % wanted.size()];
    difference |= static_cast<unsigned char>(given[i] ^ other);
  }
  return difference == 0;
}

bool accepts_gzip(std::string_view codings) {
  return any_item(codings, [](std::string_view item) {
    const std::string_view name = trimmed(item.substr(0, item.find(';')));
    if (!same_word(name, "gzip") && name != "*") return false;
    const std::size_t q = item.find("q=");
    return q == std::string_view::npos ||
           item.substr(q + 2).find_first_of("123456789") != std::string_view::npos;
  });
}

bool names_etag(std::string_view list, std::string_view etag) {
  return any_item(list, [etag](std::string_view item) {
    if (item.starts_with("W/")) item.remove_prefix(2);
    return item == etag || item == "*";
  });
}

}  // namespace irdm::viewer

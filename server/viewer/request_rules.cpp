#include "server/viewer/request_rules.hpp"

#include <algorithm>
#include <cctype>
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

/// Of HOST, HOST:PORT, [ADDRESS] or [ADDRESS]:PORT.
std::string_view without_port(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string_view::npos ? std::string_view{} : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

}  // namespace

bool origin_allowed(std::string_view origin, std::string_view host, bool token_needed) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!origin.starts_with(scheme)) continue;
    if (host.empty() || !same_word(origin.substr(scheme.size()), host)) return false;
    if (token_needed) return true;
    const std::string_view name = without_port(host);
    boost::system::error_code no_address;
    boost::asio::ip::make_address(std::string(name), no_address);
    return !no_address || same_word(name, "localhost");
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

// The viewer's HTTP side: its rules alone, and whole connections to a server that runs.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "tests/fuzz/harness.hpp"
#include "tests/viewer/example_run.hpp"
#include "tests/viewer/web_peer.hpp"
#include "viewer/request_rules.hpp"
#include "viewer/viewer_server.hpp"

namespace irdm::fuzz {

using namespace irdm::viewer;

void request_rules(Input input) {
  std::array<std::string_view, 5> line;
  std::string_view rest = text_of(input);
  for (std::string_view& each : line) {
    each = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(each.size() + 1, rest.size()));
  }
  const auto& [origin, host, given, wanted, list] = line;
  const bool open = origin_allowed(origin, host, false);
  const bool with_token = origin_allowed(origin, host, true);
  expect(with_token || !open, "what is allowed without a token is allowed with one");
  const std::size_t scheme = origin.starts_with("https") ? 8 : 7;
  expect(!with_token || origin.size() == scheme + host.size(),
         "an origin that is allowed is a scheme and the host");
  expect(same_token(given, wanted) == (given == wanted), "tokens are the same or not");
  accepts_gzip(list);
  names_etag(list, "\"0123456789abcdef\"");
}

namespace {

/// A server that shows the example scene, for as long as the process lives.
struct Site {
  explicit Site(ViewerSettings settings) : server(impatient(std::move(settings)), run) {
    spdlog::set_level(spdlog::level::off);
    server.start();
  }
  /// A peer that waits for the answer to half a request does not wait long.
  static ViewerSettings impatient(ViewerSettings settings) {
    settings.request_timeout_ms = 500;
    return settings;
  }

  test::ExampleRun run;
  ViewerServer server;
};

ViewerSettings open_to_all() {
  ViewerSettings settings;
  settings.page.add("/index.html", {"text/html", "<!doctype html>", "packed", "\"abc\"", false});
  settings.page.add("/assets/app.js", {"text/javascript", "script", "", "\"def\"", true});
  return settings;
}

/// With tokens, without a page.
ViewerSettings guarded() {
  ViewerSettings settings;
  settings.token = "0123456789abcdef";
  settings.onlooker_token = "fedcba9876543210";
  return settings;
}

/// The answer's header; empty when there is none.
std::string header_of(test::WebPeer& peer) {
  try {
    return peer.header();
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace

void http_connection(Input input) {
  static Site sites[] = {Site(open_to_all()), Site(guarded())};
  const bool with_token = !input.empty() && input[0] == '\n';
  Site& site = sites[with_token ? 1 : 0];
  const std::string_view text = text_of(input.subspan(with_token ? 1 : 0));
  const std::size_t end = text.find("\r\n\r\n");
  const std::size_t head = end == std::string_view::npos ? text.size() : end + 4;
  test::WebPeer peer(site.server.port());
  // Who opens a WebSocket has to wait for the answer.
  std::string answer;
  if (text.starts_with("GET /live ") && head < text.size()) {
    peer.send(std::string(text.substr(0, head)));
    answer = header_of(peer);
    peer.send(std::string(text.substr(head)));
  } else {
    peer.send(std::string(text));
  }
  peer.finish();
  const auto rest = peer.rest();
  expect(rest.has_value(), "a connection ends when its peer has said all");
  if (answer.empty()) answer = *rest;
  expect(answer.empty() || answer.starts_with("HTTP/1."), "an answer is HTTP");
}

}  // namespace irdm::fuzz

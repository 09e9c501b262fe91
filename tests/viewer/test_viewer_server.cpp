// The viewer's server on real sockets.
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>

#include "common/error.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/show.hpp"
#include "viewer/notice_text.hpp"
#include "viewer/viewer_server.hpp"

using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::StartsWith;
using namespace irdm;
using namespace irdm::test;
using namespace irdm::viewer;

namespace {

/// The next frame, whatever else comes before it.
SurfaceFrame next_frame(WebPeer& peer, const Scene& scene) {
  for (;;) {
    const auto message = peer.receive();
    REQUIRE(message);
    REQUIRE(message->opcode == 2);
    if (message->payload.at(6) == 2) return decode_frame(message->payload, node_counts(scene));
  }
}

/// The next state, whatever else comes before it.
State next_state(WebPeer& peer) {
  for (;;) {
    const auto message = peer.receive();
    REQUIRE(message);
    REQUIRE(message->opcode == 2);
    if (message->payload.at(6) == 4) return decode_state(message->payload, 2);
  }
}

int close_code(WebPeer& peer) {
  while (const auto message = peer.receive()) {
    if (message->opcode == 8) return message->close_code();
  }
  return -1;
}

std::size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t size = 0;
  std::size_t resident = 0;
  file >> size >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

TEST_CASE("the page comes with its headers") {
  Show show;
  const std::string page = show.get("/");
  CHECK_THAT(page, StartsWith("HTTP/1.1 200 OK"));
  CHECK_THAT(page, ContainsSubstring("Content-Type: text/html; charset=utf-8\r\n"));
  CHECK_THAT(page,
             ContainsSubstring("Content-Security-Policy: default-src 'none'; script-src 'self'"));
  CHECK_THAT(page, ContainsSubstring("X-Content-Type-Options: nosniff"));
  CHECK_THAT(page, ContainsSubstring("Cache-Control: no-cache\r\n"));
  CHECK_THAT(page, ContainsSubstring("\r\n\r\n<!doctype html>"));
  CHECK_THAT(page, !ContainsSubstring("Content-Encoding"));
  CHECK_THAT(show.get("/assets/app-1234.js?x"),
             ContainsSubstring("immutable") && ContainsSubstring("script"));
}

TEST_CASE("the page comes packed for those who take it") {
  Show show;
  const std::string packed = show.get("/", "Accept-Encoding: br, gzip;q=0.5\r\n");
  CHECK_THAT(packed, ContainsSubstring("Content-Encoding: gzip\r\n") &&
                         ContainsSubstring("\r\n\r\npacked page"));
  CHECK_THAT(show.get("/", "Accept-Encoding: gzip;q=0\r\n"), ContainsSubstring("<!doctype html>"));
}

TEST_CASE("what a browser still has is not sent again") {
  Show show;
  const std::string page = show.get("/");
  const std::size_t begin = page.find("ETag: ") + 6;
  const std::string etag = page.substr(begin, page.find('\r', begin) - begin);
  const std::string again = show.get("/", "If-None-Match: \"other\", " + etag + "\r\n");
  CHECK_THAT(again, StartsWith("HTTP/1.1 304"));
  CHECK_THAT(again, !ContainsSubstring("doctype"));
}

TEST_CASE("HEAD tells the length and sends no body, and a connection serves several requests") {
  Show show;
  WebPeer peer(show.server.port());
  for (int i = 0; i < 3; ++i) {
    peer.send("HEAD / HTTP/1.1\r\nHost: x\r\n\r\n");
    CHECK_THAT(peer.header(), ContainsSubstring("Content-Length: 15\r\n"));
  }
  peer.send("GET / HTTP/1.0\r\n\r\n");
  CHECK_THAT(*peer.rest(), StartsWith("HTTP/1.") && ContainsSubstring("<!doctype html>"));
}

TEST_CASE("only the page's own files are served, whatever the path says") {
  Show show;
  const char* path = GENERATE("/nothing", "/../index.html", "/assets/../index.html", "//index.html",
                              "/%2e%2e/index.html", "/../../../../etc/passwd", "/secret.txt",
                              "/index.html.gz", "/assets", "/assets/", "index.html", "/live/");
  CHECK_THAT(show.get(path), StartsWith("HTTP/1.1 404"));
}

TEST_CASE("a request that breaks the rules is refused with a word of why") {
  Show show;
  CHECK_THAT(show.ask("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\n\r\nab"),
             StartsWith("HTTP/1.1 413"));
  CHECK_THAT(show.ask("POST / HTTP/1.1\r\nHost: x\r\n\r\n"),
             StartsWith("HTTP/1.1 405") && ContainsSubstring("Allow: GET, HEAD"));
  CHECK_THAT(show.ask("GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 2\r\n\r\nab"),
             StartsWith("HTTP/1.1 413"));
  CHECK_THAT(show.ask("GET / HTTP/1.1\r\nHost: x\r\nX: " + std::string(100'000, 'a') + "\r\n\r\n"),
             StartsWith("HTTP/1.1 431"));
  CHECK_THAT(show.ask("IRDM\x01\x02\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  CHECK_THAT(show.get("/live"), StartsWith("HTTP/1.1 426"));
  CHECK_THAT(show.get("/"), StartsWith("HTTP/1.1 200"));
}

TEST_CASE("a request has one Host and one Origin, and a transfer coding that is known") {
  Show show;
  const auto answer = [&](const std::string& version, const std::string& fields) {
    return show.ask("GET / HTTP/" + version + "\r\nConnection: close\r\n" + fields + "\r\n");
  };
  CHECK_THAT(answer("1.1", "Host: x\r\n"), StartsWith("HTTP/1.1 200"));
  CHECK_THAT(answer("1.0", ""), ContainsSubstring(" 200 "));
  CHECK_THAT(answer("1.1", ""), StartsWith("HTTP/1.1 400"));
  CHECK_THAT(answer("1.1", "Host: x\r\nHost: x\r\n"), StartsWith("HTTP/1.1 400"));
  CHECK_THAT(answer("1.0", "Host: x\r\nhost: y\r\n"), StartsWith("HTTP/1.1 400"));
  CHECK_THAT(answer("1.1", "Host: x\r\nOrigin: http://x\r\n"), StartsWith("HTTP/1.1 200"));
  CHECK_THAT(answer("1.1", "Host: x\r\nOrigin: http://x\r\nOrigin: http://x\r\n"),
             StartsWith("HTTP/1.1 400"));
  CHECK_THAT(answer("1.1", "Host: x\r\nTransfer-Encoding: xchunked\r\n"),
             StartsWith("HTTP/1.1 501"));
  CHECK_THAT(answer("1.1", "Host: x\r\nTransfer-Encoding: gzip\r\n"), StartsWith("HTTP/1.1 501"));
  CHECK_THAT(answer("1.1", "Host: x\r\nTransfer-Encoding: chunked\r\n"),
             StartsWith("HTTP/1.1 413"));
}

TEST_CASE("a WebSocket is not opened by a request with two Origins") {
  Show show;
  const std::string host = "127.0.0.1:80";
  CHECK_THAT(
      WebPeer(show.server.port()).upgrade("http://" + host + "\r\nOrigin: http://" + host, host),
      StartsWith("HTTP/1.1 400"));
}

TEST_CASE("a page that was not built is told") {
  ExampleRun run;
  ViewerServer server({}, run);
  server.start();
  WebPeer peer(server.port());
  peer.send("GET / HTTP/1.0\r\n\r\n");
  CHECK_THAT(*peer.rest(), StartsWith("HTTP/1.1 404") && ContainsSubstring("scripts/setup.sh"));
}

TEST_CASE("only pages of this server may open a WebSocket") {
  Show show;
  const auto answer = [&](const std::string& origin, const std::string& host) {
    return WebPeer(show.server.port()).upgrade(origin, host);
  };
  CHECK_THAT(answer("http://127.0.0.1:80", "127.0.0.1:80"), StartsWith("HTTP/1.1 101"));
  CHECK_THAT(answer("http://evil.example", "127.0.0.1:80"), StartsWith("HTTP/1.1 403"));
  CHECK_THAT(answer("", "127.0.0.1:80"), StartsWith("HTTP/1.1 403"));
  CHECK_THAT(answer("http://evil.example", "evil.example"), StartsWith("HTTP/1.1 403"));
}

TEST_CASE("a viewer gets the scene, state, health and a frame, and then every newer one") {
  Show show;
  WebPeer peer = show.watch();
  const auto scene = peer.receive();
  REQUIRE(scene);
  CHECK(encode(decode_scene(scene->payload)) == encode(show.scene));
  const auto state = peer.receive();
  REQUIRE(state);
  CHECK(decode_state(state->payload, 2).stylus_free);
  const auto health = peer.receive();
  REQUIRE(health);
  CHECK(decode_health(health->payload).steps == 77);
  CHECK(next_frame(peer, show.scene).force_step == 1039);
  for (std::uint64_t step = 5000; step < 5010; ++step) {
    show.publish(step);
    CHECK(next_frame(peer, show.scene).force_step == step);
  }
}

TEST_CASE("two viewers see the same, and the first one's end is nothing to the second") {
  Show show;
  WebPeer second = show.watch();
  {
    WebPeer first = show.watch();
    next_frame(first, show.scene);
    next_frame(second, show.scene);
    show.publish(6000);
    CHECK(next_frame(first, show.scene).force_step == 6000);
    CHECK(next_frame(second, show.scene).force_step == 6000);
    CHECK(eventually([&] { return show.server.viewers() == 2; }));
  }
  show.publish(6001);
  CHECK(next_frame(second, show.scene).force_step == 6001);
  CHECK(eventually([&] { return show.server.viewers() == 1; }));
}

TEST_CASE("a viewer can put everything back") {
  Show show;
  WebPeer peer = show.watch();
  peer.send_message(encode(ClientMessage(Command{})));
  CHECK(eventually([&] { return show.run.resets == 1; }));
}

TEST_CASE("viewers are told the state at first and whenever it changes") {
  Show show;
  WebPeer peer = show.watch();
  CHECK(next_state(peer).notice == "the first one");
  peer.send_message(encode(ClientMessage(Command{CommandKind::kShowRecording, 1, 0.0})));
  CHECK(next_state(peer).notice == "the other one");
  // From here on frames come from there.
  show.run.other_surfaces.back() = example_frame(show.scene, 0.01);
  show.run.other_surfaces.back().force_step = 8000;
  show.run.other_surfaces.publish();
  show.run.other_ready.signal();
  std::uint64_t step = 0;
  while (step != 8000) step = next_frame(peer, show.scene).force_step;
  CHECK(step == 8000);
}

TEST_CASE("the stylus is that of the viewer who presses first, until it lets go") {
  Show show({.stylus_timeout_ms = 60'000});
  WebPeer first = show.watch();
  WebPeer second = show.watch();
  CHECK(next_state(first).stylus_free);
  CHECK(next_state(second).stylus_free);
  const Bytes press = encode(ClientMessage(StylusRequest{true, 0, Vector3::Zero()}));
  const Bytes release = encode(ClientMessage(StylusRequest{}));
  first.send_message(press);
  CHECK(next_state(first).holds_stylus);
  const State seen = next_state(second);
  CHECK_FALSE(seen.stylus_free);
  CHECK_FALSE(seen.holds_stylus);
  second.send_message(press);  // not looked at
  second.send_message(release);
  first.send_message(press);
  CHECK(eventually([&] { return show.run.presses == 2; }));
  first.send_message(release);
  CHECK(next_state(first).stylus_free);
  CHECK(next_state(second).stylus_free);
  CHECK(show.run.presses == 2);
  CHECK(show.run.releases == 1);
  second.send_message(press);
  CHECK(next_state(second).holds_stylus);
}

TEST_CASE("a viewer that falls silent or goes loses the stylus") {
  const bool goes = GENERATE(false, true);
  Show show({.health_period_ms = 50, .stylus_timeout_ms = goes ? 60'000 : 200});
  std::optional<WebPeer> peer = show.watch();
  peer->send_message(encode(ClientMessage(StylusRequest{true, 0, Vector3::Zero()})));
  REQUIRE(eventually([&] { return show.run.presses == 1; }));
  if (goes) peer.reset();
  CHECK(eventually([&] { return show.run.releases == 1; }));
}

TEST_CASE("who only looks on is sent everything and asks for nothing") {
  const std::string onlooker_token = "another token of 16";
  const bool by_token = GENERATE(false, true);
  Show show({.token = kToken, .onlooker_token = onlooker_token});
  WebPeer peer = by_token ? show.watch(onlooker_token) : show.watch(kToken, 0, true);
  CHECK(next_state(peer).looks_on);
  CHECK(next_frame(peer, show.scene).force_step == 1039);
  peer.send_message(encode(ClientMessage(Command{})));
  peer.send_message(encode(ClientMessage(SettingsRequest{example_state().settings, 2})));
  peer.send_message(encode(ClientMessage(StylusRequest{true, 0, Vector3::Zero()})));
  peer.send_message(encode(ClientMessage(SceneRequest{"press.toml"})));
  WebPeer other = show.watch(kToken);
  other.send_message(encode(ClientMessage(SettingsRequest{example_state().settings, 2})));
  REQUIRE(eventually([&] { return show.run.settings == 1; }));
  other.send_message(encode(ClientMessage(Command{})));
  REQUIRE(eventually([&] { return show.run.resets == 1; }));
  other.send_message(encode(ClientMessage(SceneRequest{"press.toml"})));
  REQUIRE(eventually([&] { return show.run.loads == 1; }));
  CHECK(show.run.presses == 0);
}

TEST_CASE("a message that breaks the rules ends the session") {
  Show show;
  WebPeer peer(show.server.port());
  peer.open();
  SECTION("a command before Hello") {
    peer.send_message(encode(ClientMessage(Command{})));
    CHECK(close_code(peer) == 1002);
  }
  SECTION("a scene before Hello") {
    peer.send_message(encode(ClientMessage(SceneRequest{"press.toml"})));
    CHECK(close_code(peer) == 1002);
    CHECK(show.run.loads == 0);
  }
  SECTION("a second Hello") {
    peer.send_message(encode(ClientMessage(Hello{})));
    peer.send_message(encode(ClientMessage(Hello{})));
    CHECK(close_code(peer) == 1002);
  }
  SECTION("text") {
    peer.send_message(encode(ClientMessage(Hello{})), 1);
    CHECK(close_code(peer) == 1002);
  }
  SECTION("settings of another number of objects") {
    const auto objects = static_cast<std::size_t>(GENERATE(1, 3));
    peer.send_message(encode(ClientMessage(Hello{})));
    peer.send_message(encode(ClientMessage(SettingsRequest{example_state().settings, objects})));
    CHECK(close_code(peer) == 1002);
    CHECK(show.run.settings == 0);
  }
  SECTION("too long") {
    peer.send_message(Bytes(2100, 0));
    CHECK(close_code(peer) == 1009);
  }
  CHECK(show.run.resets == 0);
  WebPeer next = show.watch();
  CHECK(next_frame(next, show.scene).force_step == 1039);
}

TEST_CASE("settings of as many objects as a scene can have are taken") {
  ExampleRun run;
  run.scene_.objects.resize(kMaxObjects, run.scene_.objects[1]);
  ViewerServer server(Show::with_page({.idle_timeout_ms = 600'000}), run);
  server.start();
  WebPeer peer(server.port());
  peer.open();
  peer.send_message(encode(ClientMessage(Hello{})));
  Settings settings = example_state().settings;
  settings.object.fill(settings.object[0]);
  peer.send_message(encode(ClientMessage(SettingsRequest{settings, kMaxObjects})));
  CHECK(eventually([&] { return run.settings == 1; }));
}

TEST_CASE("where a token is needed, only the right one opens") {
  Show show({.token = kToken});
  for (const std::string& wrong : {std::string(), kToken + "x", kToken.substr(1)}) {
    WebPeer peer = show.watch(wrong);
    CHECK(close_code(peer) == 1008);
  }
  WebPeer peer = show.watch(kToken);
  CHECK(next_frame(peer, show.scene).force_step == 1039);
}

TEST_CASE("one who knocks again and again does not fill the log") {
  const CapturedLog log;
  Show show({.token = kToken});
  std::size_t knocks = 0;
  const auto knock = [&] {
    WebPeer peer(show.server.port());
    if (++knocks % 3 == 0) {
      peer.upgrade("http://evil.example", "127.0.0.1:80");
      return;
    }
    peer.open();
    const bool command = knocks % 3 == 1;
    const ClientMessage wrong =
        command ? ClientMessage(Command{}) : ClientMessage(Hello{"x", false});
    peer.send_message(encode(wrong));
    CHECK(close_code(peer) == (command ? 1002 : 1008));
  };
  CHECK(eventually([&] {
    knock();
    return show.server.unlogged() >= 9;
  }));
  CHECK(log.lines() + show.server.unlogged() == knocks);
}

TEST_CASE("an address that can be reached from elsewhere needs a token") {
  ExampleRun run;
  CHECK_THROWS_WITH(ViewerServer({.address = "0.0.0.0"}, run), ContainsSubstring("viewer.token"));
  CHECK_THROWS_WITH(ViewerServer({.address = "nowhere"}, run), ContainsSubstring("not an address"));
  const ViewerServer with_token({.address = "0.0.0.0", .token = kToken}, run);
  CHECK_THROWS_AS(ViewerServer({.port = with_token.port()}, run), Error);
}

TEST_CASE("there is a limit to viewers") {
  Show show({.max_viewers = 2});
  WebPeer first = show.watch();
  WebPeer second = show.watch();
  next_frame(second, show.scene);
  const std::string host = "127.0.0.1:80";
  WebPeer third(show.server.port());
  CHECK_THAT(third.upgrade("http://" + host, host), StartsWith("HTTP/1.1 503"));
}

TEST_CASE("WebSockets that say nothing keep no viewer out") {
  const CapturedLog log;
  Show show({.max_viewers = 2,
             .hello_timeout_ms = 10 * kDeadlineMs,
             .idle_timeout_ms = 10 * kDeadlineMs});
  std::vector<WebPeer> silent;
  for (int i = 0; i < 3; ++i) {
    silent.emplace_back(show.server.port());
    silent.back().open();
  }
  WebPeer first = show.watch();
  WebPeer second = show.watch();
  next_frame(first, show.scene);
  next_frame(second, show.scene);
  CHECK(show.server.viewers() == 2);
  // One that opened before there were two says Hello now.
  silent.front().send_message(encode(ClientMessage(Hello{})));
  CHECK(close_code(silent.front()) == 1013);
  CHECK(log.lines() + show.server.unlogged() == 1);
}

TEST_CASE("beyond the limit of connections the oldest silent one makes room") {
  // No connection ends by itself while the test waits.
  const CapturedLog log;
  Show show({.max_connections = 3,
             .hello_timeout_ms = 10 * kDeadlineMs,
             .idle_timeout_ms = 10 * kDeadlineMs,
             .request_timeout_ms = 10 * kDeadlineMs});
  WebPeer viewer = show.watch();
  next_frame(viewer, show.scene);
  WebPeer socket(show.server.port());
  socket.open();
  WebPeer asks(show.server.port());
  const std::string request = "HEAD / HTTP/1.1\r\nHost: x\r\n\r\n";
  asks.send(request);
  CHECK_THAT(asks.header(), StartsWith("HTTP/1.1 200"));
  // Again and again, whoever comes gets in: first the WebSocket without Hello makes room.
  WebPeer next(show.server.port());
  next.send(request);
  CHECK_THAT(next.header(), StartsWith("HTTP/1.1 200"));
  CHECK(socket.rest() == "");
  asks.send(request);
  CHECK_THAT(asks.header(), StartsWith("HTTP/1.1 200"));
  WebPeer last = show.watch();
  next_frame(last, show.scene);
  CHECK(next.rest() == "");
  asks.send(request);
  CHECK_THAT(asks.header(), StartsWith("HTTP/1.1 200"));
  show.publish(7000);
  while (next_frame(viewer, show.scene).force_step != 7000) {
  }
  CHECK(log.lines() + show.server.unlogged() == 2);
}

TEST_CASE("connections that all watch are not ended for another one") {
  Show show({.max_connections = 2, .idle_timeout_ms = 600'000});
  WebPeer first = show.watch();
  WebPeer second = show.watch();
  next_frame(first, show.scene);
  next_frame(second, show.scene);
  WebPeer beyond(show.server.port());
  CHECK(beyond.rest() == "");
  show.publish(7000);
  while (next_frame(first, show.scene).force_step != 7000) {
  }
}

TEST_CASE("notices name files, not the server's folders, and are UTF-8") {
  CHECK(file_names_only("/home/a b/lab/x.toml:3: object.model is missing; add it") ==
        "x.toml:3: object.model is missing; add it");
  CHECK(file_names_only("recorded: /srv/irdm/run 1") == "recorded: run 1");
  CHECK(file_names_only("cannot open '/srv/my models/cube.h5'; see (/etc/irdm/server.toml)") ==
        "cannot open 'cube.h5'; see (server.toml)");
  for (const char* kept : {"", "coupling 300 N/m, 5 /s", "saved: a-1.toml", "/", "a / b"}) {
    CHECK(file_names_only(kept) == kept);
  }
  ExampleRun run;
  run.notice = "/secret/folder/caf\xE9.toml: is missing";
  ViewerServer server({.idle_timeout_ms = 600'000}, run);
  server.start();
  WebPeer peer(server.port());
  peer.open();
  peer.send_message(encode(ClientMessage(Hello{})));
  CHECK(next_state(peer).notice == "caf?.toml: is missing");
}

TEST_CASE("who says nothing is not waited for") {
  Show show({.hello_timeout_ms = 100, .request_timeout_ms = 100, .health_period_ms = 20});
  WebPeer silent(show.server.port());
  CHECK(silent.rest() == "");
  WebPeer slow(show.server.port());
  slow.send("GET / HT");
  CHECK(slow.rest() == "");
  WebPeer no_hello(show.server.port());
  no_hello.open();
  CHECK(no_hello.rest() == "");
}

TEST_CASE("a viewer that gives no sign of life is given up") {
  Show show({.idle_timeout_ms = 300});
  WebPeer peer = show.watch();
  while (peer.receive()) {  // pings are read and not answered
  }
  CHECK(eventually([&] { return show.server.viewers() == 0; }));
}

TEST_CASE("a viewer that reads nothing holds nobody up and costs no memory") {
  Show show;
  WebPeer dead = show.watch("", 4096);
  WebPeer alive = show.watch();
  next_frame(alive, show.scene);
  const auto frame_size = [&] {
    Bytes bytes;
    encode(example_frame(show.scene, 0.01), bytes);
    return bytes.size();
  }();
#ifdef IRDM_SANITIZED
  constexpr std::size_t kFrames = 4'000;  // more than the kernel keeps for a peer
#else
  constexpr std::size_t kFrames = 20'000;  // some 30 MB
#endif
  CAPTURE(frame_size);
  const std::size_t before = resident_bytes();
  for (std::uint64_t step = 1; step <= kFrames; ++step) {
    show.publish(step);
    if (step % 100 == 0) {
      while (next_frame(alive, show.scene).force_step != step) {
      }
    }
  }
#ifndef IRDM_SANITIZED  // a sanitizer keeps what was freed
  CHECK(resident_bytes() < before + kFrames * frame_size / 4);
#endif
  CHECK(before > 0);
}

TEST_CASE("stopping says goodbye to every viewer, and waits for none that does not listen") {
  Show show;
  WebPeer dead = show.watch("", 4096);
  WebPeer alive = show.watch();
  WebPeer silent(show.server.port());
  next_frame(alive, show.scene);
  for (std::uint64_t step = 1; step <= 3000; ++step) {  // more than the kernel keeps for the dead
    show.publish(step);
    if (step % 10 != 0) continue;
    while (next_frame(alive, show.scene).force_step != step) {
    }
  }
  const auto begin = std::chrono::steady_clock::now();
  show.server.stop();
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(3));
  CHECK(close_code(alive) == 1001);
  CHECK(show.server.viewers() == 0);
}

TEST_CASE("a server that is not started ends well, too") {
  ExampleRun run;
  const ViewerServer server({}, run);
  CHECK_THAT(server.urls().front(), StartsWith("http://127.0.0.1:"));
}

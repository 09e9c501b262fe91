#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/example_run.hpp"
#include "tests/viewer/web_peer.hpp"
#include "viewer/viewer_server.hpp"

namespace irdm::test {

inline const std::string kToken = "a token of 16 or more";

/// A page of three files, as build.mjs leaves them.
inline viewer::PageFiles example_page() {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "assets");
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.path() / name) << text;
  };
  write("index.html", "<!doctype html>");
  write("index.html.gz", "packed page");
  write("assets/app-1234.js", "script");
  write("secret.txt", "of no known type");
  return viewer::PageFiles::read(folder.path());
}

/// A server that shows it.
struct Show {
  // Peers of these tests answer no pings, and a slow machine takes its time.
  explicit Show(viewer::ViewerSettings settings = {.idle_timeout_ms = 600'000})
      : server(with_page(std::move(settings)), run) {
    server.start();
  }
  static viewer::ViewerSettings with_page(viewer::ViewerSettings settings) {
    settings.page = example_page();
    return settings;
  }
  void publish(std::uint64_t step) {
    run.surfaces.back() = example_frame(scene, 0.01);
    run.surfaces.back().force_step = step;
    run.surfaces.publish();
    run.ready.signal();
  }
  /// Asks and returns the whole answer.
  std::string ask(const std::string& request) {
    WebPeer peer(server.port());
    peer.send(request);
    const auto answer = peer.rest();
    REQUIRE(answer);
    return *answer;
  }
  std::string get(const std::string& path, const std::string& more = "") {
    return ask("GET " + path + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n" + more + "\r\n");
  }
  WebPeer watch(const std::string& token = "", int receive_buffer = 0, bool looks_on = false) {
    WebPeer peer(server.port(), receive_buffer);
    peer.open();
    peer.send_message(encode(viewer::ClientMessage(viewer::Hello{token, looks_on})));
    return peer;
  }

  ExampleRun run;
  const viewer::Scene& scene = run.scene_;
  viewer::ViewerServer server;
};

}  // namespace irdm::test

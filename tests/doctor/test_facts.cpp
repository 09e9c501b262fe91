#include <filesystem>
#include <fstream>

#include "device_bridge/doctor/facts.hpp"
#include "server/network/network_server.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/raw_peer.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

ClientSettings to_port(std::uint16_t port) {
  return {.server = {"127.0.0.1", port}};
}

}  // namespace

TEST_CASE("doctor: a server welcomes and is left in order, undisturbed") {
  NetworkServer server({.styluses = 2});
  server.start();
  const doctor::ServerFacts facts = doctor::ask_server(to_port(server.port_number()), 2);
  CHECK(facts.connects);
  CHECK(facts.welcomes);
  CHECK(facts.words.empty());
  CHECK(eventually([&] { return server.stats().goodbyes == 1; }));
  CHECK(server.stats().samples == 0);
}

TEST_CASE("doctor: a server in lockstep refuses and goes on") {
  NetworkServer server({.lockstep = true});
  server.start();
  const doctor::ServerFacts facts = doctor::ask_server(to_port(server.port_number()), 1);
  CHECK(facts.connects);
  CHECK_FALSE(facts.welcomes);
  CHECK_THAT(facts.words, ContainsSubstring("lockstep"));
  CHECK(server.stats().accepted == 0);
}

TEST_CASE("doctor: nobody listens, or nobody who answers") {
  std::uint16_t port = 0;
  {
    const RawListener listener;
    port = listener.port();
    const doctor::ServerFacts silent = doctor::ask_server(to_port(port), 1);
    CHECK(silent.connects);
    CHECK_FALSE(silent.welcomes);
  }
  const doctor::ServerFacts away = doctor::ask_server(to_port(port), 1);
  CHECK_FALSE(away.connects);
  CHECK_THAT(away.words, ContainsSubstring("no connection: "));
}

TEST_CASE("doctor: the clock is looked at, and the source is the kernel's") {
  const TemporaryFolder root;
  const auto folder = root.path() / "sys/devices/system/clocksource/clocksource0";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "current_clocksource") << "acpi_pm\n";
  const doctor::ClockFacts clock = doctor::look_at_clock(root.path());
  CHECK(clock.source == "acpi_pm");
  CHECK(clock.resolution_ns > 0);
  CHECK(clock.usual_lateness_ns > 0);
  CHECK(clock.worst_lateness_ns >= clock.usual_lateness_ns);
}

TEST_CASE("doctor: what is not permitted is told in the system's words") {
  constexpr std::size_t kMoreThanThereIs = std::size_t{1} << 60;
  const doctor::Permission memory = doctor::try_locked_memory(kMoreThanThereIs);
  CHECK_FALSE(memory.given);
  CHECK_FALSE(memory.refusal.empty());
  const doctor::Permission priority = doctor::try_real_time();
  CHECK(priority.given == priority.refusal.empty());
}

#include "device_bridge/doctor/facts.hpp"

#include <sys/mman.h>

#include <cerrno>
#include <chrono>
#include <ctime>
#include <fstream>
#include <system_error>
#include <thread>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/histogram.hpp"
#include "common/wire/asio.hpp"

namespace irdm::doctor {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;

// Why nobody answers there; empty: somebody does.
std::string connect_failure(const ServerAddress& server) {
  constexpr std::chrono::seconds kPatience(2);
  boost::asio::io_context io;
  error_code result;
  const auto endpoints =
      tcp::resolver(io).resolve(server.host, std::to_string(server.port), result);
  if (result) return "the name cannot be resolved: " + result.message();
  tcp::socket socket(io);
  result = boost::asio::error::timed_out;
  boost::asio::async_connect(socket, endpoints,
                             [&](error_code error, const tcp::endpoint&) { result = error; });
  io.run_for(kPatience);
  return result ? "no connection: " + result.message() : "";
}

}  // namespace

Permission try_real_time() {
  EventFd over;
  std::thread thread([&] { over.wait(-1); });
  Permission permission;
  try {
    apply_scheduling(RealTimeScheduling::kRequire, thread, kServoPriority);
    permission.given = true;
  } catch (const Error& error) {
    permission.refusal = error.what();
  }
  over.signal();
  thread.join();
  return permission;
}

Permission try_locked_memory(std::size_t bytes) {
  void* const memory =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return {false, std::generic_category().message(errno)};
  Permission permission{.given = ::mlock(memory, bytes) == 0};
  if (!permission.given) permission.refusal = std::generic_category().message(errno);
  ::munmap(memory, bytes);
  return permission;
}

ClockFacts look_at_clock(const std::filesystem::path& root) {
  constexpr std::int64_t kPeriodNs = 1'000'000;
  constexpr int kPeriods = 200;
  ClockFacts facts;
  std::ifstream(root / "sys/devices/system/clocksource/clocksource0/current_clocksource") >>
      facts.source;
  timespec resolution{};
  ::clock_getres(CLOCK_MONOTONIC, &resolution);
  facts.resolution_ns = resolution.tv_sec * 1'000'000'000 + resolution.tv_nsec;
  PeriodicSchedule schedule(monotonic_ns(), kPeriodNs);
  Histogram lateness;
  for (int i = 0; i < kPeriods; ++i) {
    const std::int64_t deadline_ns = schedule.next(monotonic_ns());
    sleep_until(deadline_ns);
    lateness.add(monotonic_ns() - deadline_ns);
  }
  facts.usual_lateness_ns = lateness.percentile(0.5);
  facts.worst_lateness_ns = lateness.maximum();
  return facts;
}

ServerFacts ask_server(const ClientSettings& settings, std::size_t styluses) {
  constexpr int kPatienceMs = 2000;
  ServerFacts facts;
  facts.words = connect_failure(settings.server);
  facts.connects = facts.words.empty();
  if (!facts.connects) return facts;
  ClientSettings asking = settings;
  asking.lockstep = false;
  ServoLink link(styluses);
  EventFd gave_up;
  NetworkClient client(link, asking, gave_up);
  client.start();
  const std::int64_t deadline_ns = monotonic_ns() + kPatienceMs * std::int64_t{1'000'000};
  while (!facts.welcomes && monotonic_ns() < deadline_ns && !gave_up.consume()) {
    link.news.wait(10);
    link.state.receive();
    facts.welcomes = link.state.front().sessions > 0;
  }
  client.stop(true);
  facts.words = client.report().failure;
  return facts;
}

}  // namespace irdm::doctor

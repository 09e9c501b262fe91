// Whole connections between bridge and server, one end of which says what the fuzzer likes.
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/wire/connection.hpp"
#include "common/wire/payload.hpp"
#include "device_bridge/link/server_session.hpp"
#include "server/network/session.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/mended_frames.hpp"

namespace irdm::fuzz {
namespace {

using boost::asio::ip::tcp;

/// A connection whose far end the fuzzer has. Not TCP: so many of them would use up the ports.
class Line {
 public:
  Line() {
    spdlog::set_level(spdlog::level::off);
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) std::abort();
    near_.assign(tcp::v4(), ends[0]);
    far_.assign(tcp::v4(), ends[1]);
  }

  /// The near end, once.
  std::shared_ptr<wire::Connection> connection() {
    return std::make_shared<wire::Connection>(wire::make_plain_stream(std::move(near_)));
  }
  boost::asio::any_io_executor executor() { return context_.get_executor(); }
  void say(Input bytes) {
    boost::system::error_code ignored;
    boost::asio::write(far_, boost::asio::buffer(bytes.data(), bytes.size()), ignored);
    go_on();
  }
  void say_no_more() {
    boost::system::error_code ignored;
    far_.shutdown(tcp::socket::shutdown_send, ignored);
    go_on();
  }
  void hang_up() {
    far_.close();
    go_on();
  }

 private:
  void go_on() {
    context_.restart();
    context_.poll();
  }

  boost::asio::io_context context_;
  tcp::socket near_{context_};
  tcp::socket far_{context_};
};

std::vector<std::uint8_t> mended(Input input) {
  std::vector<std::uint8_t> stream(input.begin(), input.end());
  mend(stream);
  return stream;
}

/// The greeting, and what comes after it.
std::pair<Input, Input> parted(Input stream) {
  const std::size_t greeting =
      std::min(stream.size(), wire::kHeaderSize + *wire::payload_size(wire::MessageType::kWelcome));
  return {stream.first(greeting), stream.subspan(greeting)};
}

constexpr std::int64_t kFarFutureNs = std::int64_t{1} << 60;

}  // namespace

void bridge_session(Input input) {
  Line line;
  const NetworkSettings settings{.styluses = 2, .max_frame_rate = 100};
  Wakeup arrived;
  StylusSlots slots(settings.styluses, arrived);
  NetworkStats stats;
  Allowance complaints(1.0, 1.0);
  DatagramPort port(line.executor(), {boost::asio::ip::address_v4::loopback(), 0}, true);
  Session session(kFuzzedSession, line.connection(),
                  {settings, slots, stats, complaints, [] {}, &port});
  session.start();
  line.say(mended(input));
  session.take_datagram(input, {});
  std::vector<std::uint8_t> forged(50);
  forged[0] = kFuzzedSession;
  session.take_datagram(forged, {});
  expect(stats.datagrams == 0, "nothing opens without the session's key");
  for (int slot = 0; slot < slots.count(); ++slot) {
    StylusPort& hand_over = slots.port(slot);
    const bool present = hand_over.in.receive() && hand_over.in.front().present;
    expect(!present || hand_over.in.front().sample.tip.allFinite(), "a sample's tip is finite");
    const StylusSample& sample = hand_over.in.front().sample;
    hand_over.out.put(
        {.force_step = 1, .sample_sequence = sample.sequence, .sample_time_ns = sample.time_ns});
    hand_over.model.put({});
  }
  session.send_forces();
  session.send_status({});
  line.say_no_more();
  session.check_time(kFarFutureNs);
  line.hang_up();
  expect(session.over(), "a session ends with its connection");
  expect(stats.protocol_errors + stats.refused + stats.goodbyes <= 1, "a session ends once");
}

void server_session(Input input) {
  Line line;
  ServoLink link(2);
  const ClientSettings settings{.lockstep = !input.empty() && input[0] % 2 == 1};
  const std::string name = "it";
  ClientReport report;
  ArmingPatience patience;
  int ends = 0;
  ServerSession session(line.connection(), {link, settings, name, report, patience});
  session.start([&ends](const SessionEnd&) { ++ends; });
  const std::vector<std::uint8_t> stream =
      mended(input.subspan(std::min<std::size_t>(1, input.size())));
  const auto [greeting, rest] = parted(stream);
  line.say(greeting);
  for (ServoLink::Stylus& stylus : link.styluses) stylus.sample.put({.sequence = 5});
  session.send_samples();
  line.say(rest);
  for (ServoLink::Stylus& stylus : link.styluses) {
    stylus.input.receive();
    expect(stylus.input.front().force.force.allFinite(), "a force is finite");
    if (stylus.model.receive()) {
      expect(check(stylus.model.front().model) == ContactModelFault::kNone,
             "a model that is handed on can be true");
    }
  }
  if (input.empty() || input[0] < 2) {
    session.check_time(kFarFutureNs);
  } else {
    session.stop(wire::GoodbyeReason::kStopping);
  }
  session.check_time(kFarFutureNs);
  line.hang_up();
  expect(ends == 1, "a session ends once");
}

}  // namespace irdm::fuzz

// Whole connections between bridge and server, one end of which says what the fuzzer likes.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/wire/payload.hpp"
#include "device_bridge/link/server_session.hpp"
#include "server/network/session.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/line.hpp"
#include "tests/fuzz/mended_frames.hpp"

namespace irdm::fuzz {
namespace {

/// The greeting, and what comes after it.
std::pair<Input, Input> parted(Input stream) {
  const std::size_t greeting =
      std::min(stream.size(), wire::kHeaderSize + *wire::payload_size(wire::MessageType::kWelcome));
  return {stream.first(greeting), stream.subspan(greeting)};
}

}  // namespace

void bridge_session(Input input) {
  Line line;
  const NetworkSettings settings{.styluses = 2, .max_frame_rate = 100};
  StylusSlots slots(settings.styluses);
  NetworkStats stats;
  TokenBucket complaints(1.0, 1.0);
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
      expect(check(stylus.model.front().value) == ContactModelFault::kNone,
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

// Sessions that have datagrams beside their connection: what comes by either of them, and what
// happens in between.
#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "common/realtime/clock.hpp"
#include "common/wire/frame.hpp"
#include "device_bridge/link/server_session.hpp"
#include "server/network/session.hpp"
#include "tests/fuzz/far_end.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/line.hpp"
#include "tests/fuzz/mended_frames.hpp"

namespace irdm::fuzz {
namespace {

using boost::asio::ip::udp;

/// What the records of both harnesses have in common; those before kAgain have bytes.
enum : std::uint8_t { kStream, kSealed, kFrame, kForeign, kAgain, kSpoilt, kLost, kTraffic, kTime };
constexpr std::uint8_t kRecordKinds = 9;

bool bit(Input input, unsigned number) {
  return !input.empty() && (input[0] >> number & 1) != 0;
}

/// Finite where it must be, and numbers that are not one where it need not.
constexpr double number_of(bool finite) {
  return finite ? 0.5 : std::numeric_limits<double>::quiet_NaN();
}

/// Makes the kinds that are datagrams; `arrive` is given each of them.
template <typename Arrive>
void send_datagrams(FarEnd& end, const Records::Record& record, const Arrive& arrive) {
  switch (record.kind) {
    case kSealed:
      return arrive(end.sealed(record.bytes));
    case kFrame:
      for (const auto& datagram : end.frame(record.bytes)) arrive(datagram);
      return;
    case kForeign:
      return arrive(record.bytes);
    case kAgain:
      return arrive(end.last());
    case kSpoilt:
      return arrive(end.spoilt(record.number));
    default:
      return end.lose(record.number % 2048);
  }
}

/// A session of a server, whose bridge the fuzzer is.
class ServedBridge {
 public:
  explicit ServedBridge(Input input)
      : settings_{.lockstep = bit(input, 0), .styluses = 2, .max_frame_rate = 100},
        room_(bit(input, 3)),
        session_(kFuzzedSession, line_.connection(),
                 {settings_, slots_, stats_, complaints_, [this] { make_room(); },
                  bit(input, 1) ? nullptr : &port_}) {
    if (bit(input, 2)) slots_.claim(1, false);
    session_.start();
    if (bit(input, 4)) return;
    greet(!bit(input, 5));
  }

  void take(const Records::Record& record) {
    switch (record.kind) {
      case kStream:
        return line_.say(mended(record.bytes));
      case kTraffic:
        return send(record.number);
      case kTime:
        return wait(record.number);
      default:
        if (bridge_) {
          send_datagrams(*bridge_, record,
                         [this](Input datagram) { session_.take_datagram(datagram, from_); });
        }
    }
    line_.go_on();
  }

  void end(bool displaced) {
    hear();
    for (int slot = 0; slot < slots_.count(); ++slot) {
      StylusPort& port = slots_.port(slot);
      const bool present = port.in.receive() && port.in.front().present;
      expect(!present || port.in.front().sample.tip.allFinite(), "a sample's tip is finite");
    }
    if (displaced && session_.unwelcomed()) session_.evict();
    line_.hang_up();
    expect(session_.over() && !session_.ending(), "a session ends with its connection");
    expect(stats_.protocol_errors + stats_.refused + stats_.goodbyes + stats_.timeouts <= 1,
           "a session ends once");
  }

 private:
  void greet(bool lockstep) {
    const wire::Hello hello{
        .capabilities = 0x1F, .styluses = 2, .lockstep = lockstep, .name = "bridge"};
    line_.say(wire::encode_frame(hello, 0, 0, 0).view());
    for (const wire::Message& message : hear()) {
      const auto* offer = std::get_if<wire::Datagrams>(&message);
      if (offer == nullptr) continue;
      expect(offer->port == port_.number(), "the port that is offered is there");
      bridge_.emplace(wire::keys_of(offer->random), wire::DatagramEnd::kBridge, kFuzzedSession);
    }
  }
  std::vector<wire::Message> hear() {
    const auto bytes = line_.heard();
    stream_.insert(stream_.end(), bytes.begin(), bytes.end());
    return messages_of(stream_);
  }
  void make_room() {
    if (room_) slots_.release(0, 1, false);
  }
  void send(std::size_t number) {
    const bool finite = number % 2 == 0;
    for (int slot = 0; slot < slots_.count(); ++slot) {
      StylusPort& port = slots_.port(slot);
      port.in.receive();
      const StylusSample& sample = port.in.front().sample;
      port.out.put({.force_step = ++step_,
                    .sample_sequence = sample.sequence,
                    .sample_time_ns = sample.time_ns,
                    .force = Vector3::Constant(number_of(finite))});
      port.model.put({.session = port.in.front().session, .value = {}});
    }
    session_.send_forces();
    session_.send_status({.steps = step_});
  }
  void wait(std::size_t milliseconds) {
    const std::int64_t now_ns =
        monotonic_ns() + static_cast<std::int64_t>(milliseconds) * kNanosecondsPerMillisecond;
    if (milliseconds % 2 == 1) session_.yield(now_ns);
    session_.check_time(now_ns);
  }

  Line line_{Line::Kind::kLoopback};
  NetworkSettings settings_;
  bool room_;
  StylusSlots slots_{2};
  NetworkStats stats_;
  TokenBucket complaints_{1.0, 1.0};
  DatagramPort port_{line_.executor(), {boost::asio::ip::address_v4::loopback(), 0}, true};
  Session session_;
  // Where what the server answers goes, and nobody reads it.
  udp::socket socket_{line_.executor(), {boost::asio::ip::address_v4::loopback(), 0}};
  udp::endpoint from_ = socket_.local_endpoint();
  std::optional<FarEnd> bridge_;
  std::vector<std::uint8_t> stream_;
  std::uint64_t step_ = 0;
};

/// A session of a bridge, whose server the fuzzer is.
class JoinedServer {
 public:
  explicit JoinedServer(Input input)
      : settings_{.lockstep = bit(input, 0), .predict = !bit(input, 1), .udp = !bit(input, 2)},
        session_(line_.connection(), {link_, settings_, name_, report_, patience_}) {
    session_.start([this](const SessionEnd&) { ++ends_; });
    if (bit(input, 3)) return;
    const wire::Welcome welcome{.capabilities = bit(input, 4) ? 0xFU : 0x1FU,
                                .session = kFuzzedSession,
                                .lockstep = bit(input, 5),
                                .dt = wire::kLongestStep};
    line_.say(wire::encode_frame(welcome, kFuzzedSession, 0, 0).view());
    if (!bit(input, 6)) offer();
  }

  void take(const Records::Record& record) {
    switch (record.kind) {
      case kStream:
        return line_.say(mended(record.bytes));
      case kTraffic:
        return send(record.number);
      case kTime:
        return wait(record.number);
      default:
        send_datagrams(server_, record, [this](Input datagram) { arrive(datagram); });
    }
    line_.go_on();
  }

  void end(bool stopped) {
    messages_of(line_.heard());
    for (ServoLink::Stylus& stylus : link_.styluses) {
      stylus.input.receive();
      expect(stylus.input.front().force.force.allFinite(), "a force is finite");
      if (stylus.model.receive()) {
        expect(check(stylus.model.front().value) == ContactModelFault::kNone,
               "a model that is handed on can be true");
      }
    }
    if (stopped) session_.stop(wire::GoodbyeReason::kStopping);
    line_.hang_up();
    expect(ends_ == 1, "a session ends once");
  }

 private:
  /// The bridge asks at once, and so tells where it is.
  void offer() {
    const wire::Datagrams offer{socket_.local_endpoint().port(), kRandom};
    line_.say(wire::encode_frame(offer, kFuzzedSession, 1, 0).view());
    std::array<std::uint8_t, wire::kLargestDatagram> probe;
    boost::system::error_code none;
    socket_.receive_from(boost::asio::buffer(probe), bridge_, 0, none);
  }
  void arrive(Input datagram) {
    boost::system::error_code ignored;
    if (bridge_.port() != 0) {
      socket_.send_to(boost::asio::buffer(datagram.data(), datagram.size()), bridge_, 0, ignored);
    }
    line_.go_on();
  }
  void send(std::size_t number) {
    for (ServoLink::Stylus& stylus : link_.styluses) {
      stylus.sample.put({.sequence = ++sequence_});
      stylus.applied.put(
          {.session = number % 4,
           .value = {.step = 20, .count = static_cast<int>(1 + number % 16), .past = {}}});
      stylus.armed = number % 2 == 0;
    }
    session_.send_samples();
  }
  void wait(std::size_t milliseconds) {
    now_ns_ += static_cast<std::int64_t>(milliseconds) * kNanosecondsPerMillisecond;
    session_.check_time(now_ns_);
  }

  static constexpr wire::KeyMaterial kRandom = {1, 2, 3};
  Line line_{Line::Kind::kLoopback};
  ServoLink link_{2};
  ClientSettings settings_;
  std::string name_ = "it";
  ClientReport report_;
  ArmingPatience patience_;
  int ends_ = 0;
  ServerSession session_;
  udp::socket socket_ = open();
  udp::endpoint bridge_;
  FarEnd server_{wire::keys_of(kRandom), wire::DatagramEnd::kServer, kFuzzedSession};
  std::uint64_t sequence_ = 0;
  std::int64_t now_ns_ = monotonic_ns();

  udp::socket open() {
    udp::socket socket(line_.executor(), {boost::asio::ip::address_v4::loopback(), 0});
    socket.non_blocking(true);
    return socket;
  }
};

/// The first byte chooses, with its highest bit how it ends.
template <typename Played>
void play(Input input) {
  Played session(input);
  Records records(input.subspan(std::min<std::size_t>(1, input.size())), kRecordKinds, kAgain);
  while (const auto record = records.next()) session.take(*record);
  session.end(bit(input, 7));
}

}  // namespace

void bridge_datagrams(Input input) {
  play<ServedBridge>(input);
}

void server_datagrams(Input input) {
  play<JoinedServer>(input);
}

}  // namespace irdm::fuzz

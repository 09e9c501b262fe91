#include <cstdint>
#include <string>
#include <vector>

#include "common/wire/frame.hpp"
#include "common/wire/protocol_error.hpp"
#include "tests/support/catch.hpp"
#include "tests/wire/from_hex.hpp"

using namespace irdm::wire;
using irdm::ContactState;
using irdm::Quaternion;
using irdm::Vector3;
using irdm::test::from_hex;

namespace {

std::vector<std::uint8_t> encoded(const Message& message, std::uint32_t session = 0x01020304) {
  const FrameBytes frame = encode_frame(message, session, 0x1112131415161718, 0x2122232425262728);
  return {frame.view().begin(), frame.view().end()};
}

/// The literal bytes of a frame, after header fields that are the same in all of these tests.
std::vector<std::uint8_t> golden(const std::string& type_and_size, const std::string& crc,
                                 const std::string& payload) {
  return from_hex("49 52 44 4d 01 00 " + type_and_size +
                  " 04 03 02 01  18 17 16 15 14 13 12 11  28 27 26 25 24 23 22 21 " + crc +
                  payload);
}

template <typename T>
T round_trip(const T& message) {
  const std::vector<std::uint8_t> bytes = encoded(message);
  std::span<const std::uint8_t> rest(bytes);
  FrameReader reader;
  const std::optional<Frame> frame = reader.read(rest);
  REQUIRE(frame);
  CHECK(rest.empty());
  CHECK_FALSE(reader.partial());
  CHECK(frame->header.version == 1);
  CHECK(frame->header.session == 0x01020304);
  CHECK(frame->header.sequence == 0x1112131415161718);
  CHECK(frame->header.send_time_ns == 0x2122232425262728);
  return std::get<T>(frame->message);
}

const std::string kThreeNumbers =
    "00 00 00 00 00 00 f0 3f "
    "00 00 00 00 00 00 00 c0 "
    "00 00 00 00 00 00 e0 3f ";

}  // namespace

TEST_CASE("hello has its documented bytes") {
  const Hello hello{.version_min = 1,
                    .version_max = 2,
                    .capabilities = 0x80000001,
                    .styluses = 3,
                    .lockstep = true,
                    .name = "desk"};
  std::string name = "64 65 73 6b ";
  for (int i = 0; i < 28; ++i) name += "00 ";
  CHECK(encoded(hello) ==
        golden("01 00 2c 00 00 00", "ce b8 eb 6d ", "01 00 02 00 01 00 00 80 03 00 01 00 " + name));
  const Hello back = round_trip(hello);
  CHECK(back.version_min == 1);
  CHECK(back.version_max == 2);
  CHECK(back.capabilities == 0x80000001);
  CHECK(back.styluses == 3);
  CHECK(back.lockstep);
  CHECK(back.name == "desk");
}

TEST_CASE("welcome has its documented bytes") {
  const Welcome welcome{.version = 1,
                        .first_stylus = 2,
                        .capabilities = 5,
                        .session = 0x0A0B0C0D,
                        .lockstep = true,
                        .dt = 0.5};
  CHECK(encoded(welcome) ==
        golden("02 00 18 00 00 00", "d6 05 a8 fb ",
               "01 00 02 00 05 00 00 00 0d 0c 0b 0a 01 00 00 00 00 00 00 00 00 00 e0 3f"));
  const Welcome back = round_trip(welcome);
  CHECK(back.version == 1);
  CHECK(back.first_stylus == 2);
  CHECK(back.capabilities == 5);
  CHECK(back.session == 0x0A0B0C0D);
  CHECK(back.lockstep);
  CHECK(back.dt == 0.5);
}

TEST_CASE("refuse has its documented bytes") {
  const Refuse refuse{
      .reason = RefuseReason::kNoFreeStylus, .version_min = 1, .version_max = 2, .text = "no"};
  std::string text = "6e 6f ";
  for (int i = 0; i < 62; ++i) text += "00 ";
  CHECK(encoded(refuse) ==
        golden("03 00 48 00 00 00", "72 b7 8b ed ", "02 00 01 00 02 00 00 00 " + text));
  const Refuse back = round_trip(refuse);
  CHECK(back.reason == RefuseReason::kNoFreeStylus);
  CHECK(back.version_min == 1);
  CHECK(back.version_max == 2);
  CHECK(back.text == "no");
}

TEST_CASE("goodbye has its documented bytes") {
  const Goodbye goodbye{GoodbyeReason::kTimeout};
  CHECK(encoded(goodbye) == golden("04 00 04 00 00 00", "b9 1b 40 12 ", "03 00 00 00"));
  CHECK(round_trip(goodbye).reason == GoodbyeReason::kTimeout);
}

TEST_CASE("sample has its documented bytes") {
  const SampleMessage message{.stylus = 1,
                              .sample = {.sequence = 7,
                                         .time_ns = -2,
                                         .buttons = 1,
                                         .tip = Vector3(1.0, -2.0, 0.5),
                                         .orientation = Quaternion(0.0, 1.0, 0.0, 0.0)}};
  CHECK(encoded(message) == golden("05 00 50 00 00 00", "bd fb 7a 5b ",
                                   "01 00 00 00  01 00 00 00  07 00 00 00 00 00 00 00 "
                                   "fe ff ff ff ff ff ff ff " +
                                       kThreeNumbers +
                                       "00 00 00 00 00 00 00 00  00 00 00 00 00 00 f0 3f "
                                       "00 00 00 00 00 00 00 00  00 00 00 00 00 00 00 00"));
  const SampleMessage back = round_trip(message);
  CHECK(back.stylus == 1);
  CHECK(back.sample.sequence == 7);
  CHECK(back.sample.time_ns == -2);
  CHECK(back.sample.buttons == 1);
  CHECK(back.sample.tip == message.sample.tip);
  CHECK(back.sample.orientation.coeffs() == message.sample.orientation.coeffs());
}

TEST_CASE("force has its documented bytes") {
  const ForceMessage message{.stylus = 2,
                             .force = {.force_step = 9,
                                       .sample_sequence = 8,
                                       .sample_time_ns = 6,
                                       .contact = ContactState::kHeld,
                                       .force = Vector3(1.0, -2.0, 0.5),
                                       .proxy = Vector3::Zero()}};
  std::string zeros;
  for (int i = 0; i < 24; ++i) zeros += "00 ";
  CHECK(encoded(message) ==
        golden("06 00 50 00 00 00", "73 1e 3d 99 ",
               "02 00 02 00 00 00 00 00  09 00 00 00 00 00 00 00  08 00 00 00 00 00 00 00 "
               "06 00 00 00 00 00 00 00 " +
                   kThreeNumbers + zeros));
  const ForceMessage back = round_trip(message);
  CHECK(back.stylus == 2);
  CHECK(back.force.force_step == 9);
  CHECK(back.force.sample_sequence == 8);
  CHECK(back.force.sample_time_ns == 6);
  CHECK(back.force.contact == ContactState::kHeld);
  CHECK(back.force.force == message.force.force);
  CHECK(back.force.proxy == message.force.proxy);
  CHECK_FALSE(back.with_torque);
  CHECK(back.force.torque.isZero(0.0));
}

TEST_CASE("force with torque has its documented bytes, and without it no torque at all") {
  ForceMessage message{.stylus = 2,
                       .force = {.force_step = 9,
                                 .sample_sequence = 8,
                                 .sample_time_ns = 6,
                                 .contact = ContactState::kHeld,
                                 .force = Vector3(1.0, -2.0, 0.5),
                                 .torque = Vector3(-2.0, 0.5, 1.0)},
                       .with_torque = true};
  std::string zeros;
  for (int i = 0; i < 24; ++i) zeros += "00 ";
  CHECK(encoded(message) ==
        golden("06 00 68 00 00 00", "28 cb 2f 06 ",
               "02 00 02 00 00 00 00 00  09 00 00 00 00 00 00 00  08 00 00 00 00 00 00 00 "
               "06 00 00 00 00 00 00 00 " +
                   kThreeNumbers + zeros +
                   "00 00 00 00 00 00 00 c0 00 00 00 00 00 00 e0 3f 00 00 00 00 00 00 f0 3f"));
  const ForceMessage back = round_trip(message);
  CHECK(back.with_torque);
  CHECK(back.force.force == message.force.force);
  CHECK(back.force.torque == message.force.torque);
  message.with_torque = false;
  CHECK(encoded(message).size() == kHeaderSize + 80);
  CHECK(round_trip(message).force.torque.isZero(0.0));
}

TEST_CASE("report has its documented bytes") {
  const Report report{.stylus = 3, .round_trip = {1.0F, 2.0F, 4.0F}, .age = {0.5F, 0.25F, 8.0F}};
  CHECK(encoded(report) == golden("07 00 20 00 00 00", "b3 51 d7 4d ",
                                  "03 00 00 00 00 00 00 00  00 00 80 3f 00 00 00 40 00 00 80 40 "
                                  "00 00 00 3f 00 00 80 3e 00 00 00 41"));
  const Report back = round_trip(report);
  CHECK(back.stylus == 3);
  CHECK(back.round_trip.p99 == 2.0F);
  CHECK(back.age.maximum == 8.0F);
}

TEST_CASE("status has its documented bytes") {
  const Status status{.steps = 1,
                      .missed = 2,
                      .unsolved = 3,
                      .overflows = 4,
                      .step_time = {1.0F, 2.0F, 4.0F},
                      .wakeup_delay = {0.5F, 0.25F, 8.0F},
                      .surface_rate = 2.0F};
  CHECK(encoded(status) ==
        golden("12 00 40 00 00 00", "35 d1 4b 0d ",
               "01 00 00 00 00 00 00 00  02 00 00 00 00 00 00 00  03 00 00 00 00 00 00 00 "
               "04 00 00 00 00 00 00 00  00 00 80 3f 00 00 00 40 00 00 80 40 "
               "00 00 00 3f 00 00 80 3e 00 00 00 41  00 00 00 40 00 00 00 00"));
  const Status back = round_trip(status);
  CHECK(back.steps == 1);
  CHECK(back.missed == 2);
  CHECK(back.unsolved == 3);
  CHECK(back.overflows == 4);
  CHECK(back.step_time.p99 == 2.0F);
  CHECK(back.wakeup_delay.maximum == 8.0F);
  CHECK(back.surface_rate == 2.0F);
}

TEST_CASE("text is cut to its field and cleaned of what a log should not see") {
  CHECK(round_trip(Hello{.name = std::string(100, 'x')}).name == std::string(kNameSize, 'x'));
  CHECK(round_trip(Hello{.name = "a\nb\x1b"}).name == "a?b?");
}

TEST_CASE("datagrams has its documented bytes, and a port") {
  Datagrams offer{.port = 0x0201};
  offer.random.fill(0xAB);
  const std::vector<std::uint8_t> bytes = encoded(offer);
  REQUIRE(bytes.size() == kHeaderSize + 40);
  CHECK(bytes[6] == 20);
  std::string payload = "01 02 00 00 00 00 00 00 ";
  for (int i = 0; i < 32; ++i) payload += "ab ";
  CHECK(std::vector<std::uint8_t>(bytes.begin() + kHeaderSize, bytes.end()) == from_hex(payload));
  const Datagrams back = round_trip(offer);
  CHECK(back.port == offer.port);
  CHECK(back.random == offer.random);
  offer.port = 0;
  CHECK_THROWS_AS(round_trip(offer), ProtocolError);
}

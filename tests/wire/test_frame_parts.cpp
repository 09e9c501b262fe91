#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include "common/wire/frame.hpp"
#include "common/wire/protocol_error.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::wire;

namespace {

using Bytes = std::vector<std::uint8_t>;

Message model_of(std::uint64_t step, int horizon) {
  ContactModelMessage message{.stylus = 1};
  message.model.valid = true;
  message.model.step = step;
  message.model.horizon = horizon;
  message.model.dt = 0.002;
  for (auto& response : message.model.response) response.setConstant(1.0);
  return message;
}

Bytes frame_of(const Message& message, std::uint64_t sequence = 0) {
  const FrameBytes frame = encode_frame(message, 7, sequence, 9);
  return {frame.view().begin(), frame.view().end()};
}

Bytes text_of(const Bytes& frame, std::size_t part) {
  const PartText text = part_text(frame, part);
  return {text.view().begin(), text.view().end()};
}

std::uint64_t step_of(const std::optional<Frame>& frame) {
  return std::get<ContactModelMessage>(frame->message).model.step;
}

}  // namespace

TEST_CASE("a small message is one part, without the zeros at its end") {
  const Bytes frame = frame_of(SampleMessage{.stylus = 3, .sample = {.sequence = 5}});
  CHECK(part_count(frame) == 1);
  const Bytes text = text_of(frame, 0);
  CHECK(Bytes(text.begin(), text.begin() + 8) == Bytes{0, 1, 0, 0, 'I', 'R', 'D', 'M'});
  // The orientation's w is the last that is not zero: 24 zeros of x, y and z are not sent.
  CHECK(text.size() == kPartHeaderSize + frame.size() - 24);
  CHECK(std::equal(text.begin() + kPartHeaderSize, text.end(), frame.begin()));
  FrameAssembly assembly;
  const std::optional<Frame> back = assembly.take(0, text);
  REQUIRE(back);
  CHECK(back->header.session == 7);
  CHECK(std::get<SampleMessage>(back->message).sample.sequence == 5);
  CHECK(std::ranges::equal(assembly.bytes(), frame));
}

TEST_CASE("applied forces of 15 steps are one datagram, a whole contact model is four") {
  AppliedForcesMessage message{};
  message.applied.step = 100;
  for (auto& each : message.applied.past)
    each = {Vector3(1, 1, 1), Vector3(1, 1, 1), Vector3(1, 1, 1)};
  message.applied.count = kForcesInDatagram;
  CHECK(part_count(frame_of(message)) == 1);
  message.applied.count = kForcesInDatagram + 1;
  CHECK(part_count(frame_of(message)) == 2);
  CHECK(part_count(frame_of(model_of(1, kMaxHorizon))) == 4);
  CHECK(part_count(frame_of(model_of(1, kMaxHorizon))) == kMostParts);
  CHECK(part_count(frame_of(ContactModelMessage{})) == 1);
}

TEST_CASE("parts of many messages make them whole in any order") {
  constexpr std::size_t kMessages = FrameAssembly::kFrames;
  std::mt19937 random(2);
  for (int run = 0; run < 50; ++run) {
    std::vector<std::pair<std::uint64_t, Bytes>> texts;
    for (std::uint64_t step = 0; step < kMessages; ++step) {
      const Bytes frame = frame_of(model_of(step, 1 + static_cast<int>(random() % 50)), step);
      const std::size_t parts = part_count(frame);
      for (std::size_t part = 0; part < parts; ++part) {
        texts.emplace_back(10 * step + part, text_of(frame, part));
      }
    }
    std::shuffle(texts.begin(), texts.end(), random);
    FrameAssembly assembly;
    std::vector<int> whole(kMessages);
    for (const auto& [number, text] : texts) {
      const std::optional<Frame> frame = assembly.take(number, text);
      if (frame) ++whole[step_of(frame)];
    }
    CHECK(whole == std::vector<int>(kMessages, 1));
  }
}

TEST_CASE("a lost part loses its message only, and the oldest make room") {
  FrameAssembly assembly;
  std::uint64_t whole = 0;
  constexpr std::uint64_t kSteps = 1000;
  for (std::uint64_t step = 0; step < kSteps; ++step) {
    const Bytes frame = frame_of(model_of(step, kMaxHorizon), step);
    for (std::size_t part = 0; part < 4; ++part) {
      if (step % 2 == 0 && part == step % 4) continue;
      if (assembly.take(4 * step + part, text_of(frame, part))) ++whole;
    }
  }
  CHECK(whole == kSteps / 2);
  // What is older than all that is incomplete has no place.
  CHECK_FALSE(assembly.take(0, text_of(frame_of(model_of(0, kMaxHorizon)), 0)));
}

TEST_CASE("texts that are no part of a message are errors, one by one") {
  const Bytes model = frame_of(model_of(1, kMaxHorizon));
  const Bytes good = text_of(model, 0);
  const auto refused = [&](Bytes text, std::uint64_t number = 100) {
    FrameAssembly assembly;
    assembly.take(100, good);
    CHECK_THROWS_AS(assembly.take(number, text), ProtocolError);
  };
  const auto changed = [](Bytes text, std::size_t at, std::uint8_t value) {
    text[at] = value;
    return text;
  };
  refused({});
  refused({0, 1, 0});
  refused({0, 1, 0, 0});                              // nothing of a message
  refused(changed(good, 0, 4), 104);                  // fifth of four
  refused(changed(good, 1, kMostParts + 1), 200);     // too many
  refused(changed(text_of(model, 1), 1, 3), 101);     // of another number of parts
  refused(text_of(model, 1), 0);                      // before the first datagram
  refused(Bytes(good.begin(), good.end() - 1), 200);  // cut, and not the last
  refused({0, 1, 0, 0, 'X'}, 200);                    // no frame
  refused(changed(good, 1, 0), 200);                  // of no parts
  Bytes two = {0, 1, 0, 0};
  const Bytes goodbye = frame_of(Goodbye{});
  two.insert(two.end(), goodbye.begin(), goodbye.end());
  two.push_back(1);  // more than a message
  refused(two, 200);
}

TEST_CASE("a probe is as large as a datagram can be and no part of a message") {
  CHECK(probe_text().size == kLargestText);
  CHECK(is_probe(probe_text().view()));
  CHECK_FALSE(is_probe(text_of(frame_of(Goodbye{}), 0)));
  CHECK_FALSE(is_probe({}));
  Bytes of_no_parts = text_of(frame_of(Goodbye{}), 0);
  of_no_parts[1] = 0;
  CHECK_FALSE(is_probe(of_no_parts));
  CHECK_FALSE(is_probe(Bytes(kPartHeaderSize, 0)));
}

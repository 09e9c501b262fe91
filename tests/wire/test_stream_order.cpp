#include <cstdint>
#include <limits>

#include "common/wire/stream.hpp"
#include "tests/support/catch.hpp"

using namespace irdm::wire;

namespace {

Frame frame(std::uint64_t sequence, const Message& message) {
  return {{.sequence = sequence}, message};
}

}  // namespace

TEST_CASE("what is overtaken by a newer one of its kind and stylus is late") {
  StreamOrder order;
  CHECK(order.take(frame(5, SampleMessage{.stylus = 0})));
  CHECK_FALSE(order.take(frame(5, SampleMessage{.stylus = 0})));
  CHECK_FALSE(order.take(frame(4, SampleMessage{.stylus = 0})));
  CHECK(order.take(frame(4, SampleMessage{.stylus = 1})));
  CHECK(order.take(frame(4, AppliedForcesMessage{.stylus = 0})));
  CHECK(order.take(frame(3, ForceMessage{.stylus = 0})));
  CHECK(order.take(frame(2, ContactModelMessage{.stylus = 0})));
  CHECK_FALSE(order.take(frame(2, ContactModelMessage{.stylus = 0})));
  CHECK(order.take(frame(6, SampleMessage{.stylus = 0})));
}

TEST_CASE("after the highest number of all nothing is news") {
  constexpr std::uint64_t kHighest = std::numeric_limits<std::uint64_t>::max();
  StreamOrder order;
  CHECK(order.take(frame(kHighest, SampleMessage{.stylus = 0})));
  CHECK_FALSE(order.take(frame(kHighest, SampleMessage{.stylus = 0})));
  CHECK_FALSE(order.take(frame(0, SampleMessage{.stylus = 0})));
}

TEST_CASE("what is no stream, or of a stylus that no server has, has no order here") {
  StreamOrder order;
  for (int i = 0; i < 2; ++i) {
    CHECK(order.take(frame(1, Goodbye{})));
    CHECK(order.take(frame(1, Report{})));
    CHECK(order.take(frame(1, SampleMessage{.stylus = 64})));
    CHECK(order.take(frame(1, SampleMessage{.stylus = 65535})));
  }
  CHECK(is_of_stream(SampleMessage{}));
  CHECK(is_of_stream(ForceMessage{}));
  CHECK(is_of_stream(ContactModelMessage{}));
  CHECK(is_of_stream(AppliedForcesMessage{}));
  CHECK_FALSE(is_of_stream(Report{}));
  CHECK_FALSE(is_of_stream(Status{}));
  CHECK_FALSE(is_of_stream(Datagrams{}));
}

#include <atomic>
#include <cstdint>
#include <thread>
#include <utility>

#include "common/realtime/triple_buffer.hpp"
#include "tests/support/catch.hpp"

using irdm::TripleBuffer;

TEST_CASE("mailbox hands over the newest value and only once") {
  TripleBuffer<int> mailbox(7);
  CHECK(mailbox.front() == 7);
  CHECK_FALSE(mailbox.receive());
  mailbox.put(1);
  mailbox.put(2);
  REQUIRE(mailbox.receive());
  CHECK(mailbox.front() == 2);
  CHECK_FALSE(mailbox.receive());
  CHECK(mailbox.front() == 2);
}

TEST_CASE("mailbox never shows a torn or an older value while both sides run") {
  struct Pair {
    std::uint64_t a = 0, b = 0;
  };
  constexpr std::uint64_t kLast = 200'000;
  TripleBuffer<Pair> mailbox;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) mailbox.put({i, ~i});
  });
  std::uint64_t newest = 0;
  std::uint64_t torn = 0;
  std::uint64_t backward = 0;
  while (newest < kLast) {
    if (!mailbox.receive()) continue;
    const Pair pair = mailbox.front();
    if (pair.b != ~pair.a) ++torn;
    if (pair.a <= newest) ++backward;
    newest = pair.a;
  }
  writer.join();
  CHECK(torn == 0);
  CHECK(backward == 0);
}

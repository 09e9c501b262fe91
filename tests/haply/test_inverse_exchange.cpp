#include <string>

#include "device_bridge/haply/inverse_exchange.hpp"
#include "tests/bridge/milliseconds.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::haply;
using irdm::test::kMs;

namespace {

const std::optional<InverseStatus> kReadyStatus = InverseStatus{.calibrated = true, .ready = true};

/// An exchange with a device, on a clock of the test's.
struct ExchangeRig {
  ExchangeRig() {
    exchange.begin({.device = "049D", .key = ForceKey::kVector}, kReadyStatus);
    state();
  }
  // A message goes out and is answered within a millisecond.
  std::optional<std::string> turn() {
    const std::optional<std::string> message = exchange.next(now_ns);
    if (message) exchange.sent(now_ns);
    now_ns += kMs;
    if (message) exchange.answered(now_ns);
    return message;
  }
  void state(const std::optional<InverseStatus>& status = {}) {
    exchange.take({.id = "049D", .status = status, .tip = Vector3(0, 0, 0)}, {}, now_ns);
    mailbox.reading.receive();
  }
  // By the servo loop, for the reading that it has.
  void ask(double newton) {
    mailbox.force.put({now_ns, mailbox.reading.front().generation, Vector3(0, newton, 0)});
  }
  // The same text as that force has.
  static std::string of(double newton) {
    return encode_force("049D", Vector3(0, newton, 0), ForceKey::kVector);
  }

  InverseMailbox mailbox;
  TroubleText trouble{"Haply device 049D"};
  InverseReport report;
  InverseExchange exchange{mailbox, trouble, report};
  std::int64_t now_ns = 1000 * kMs;
};

}  // namespace

TEST_CASE("exchange: the newest force goes out, until it is older than 50 ms") {
  ExchangeRig rig;
  rig.ask(1.0);
  CHECK(rig.turn() == ExchangeRig::of(1.0));
  rig.ask(2.0);
  CHECK(rig.turn() == ExchangeRig::of(2.0));
  rig.now_ns += 50 * kMs;
  CHECK(rig.turn() == ExchangeRig::of(0.0));
  CHECK(rig.report.answers == 3);
  CHECK(rig.report.sum == Approx(3e-3));
}

TEST_CASE("exchange: a device that is not ready has no force, and begins anew when it is") {
  ExchangeRig rig;
  rig.ask(1.0);
  CHECK(rig.turn() == ExchangeRig::of(1.0));
  const std::uint64_t before = rig.mailbox.reading.front().generation;
  SECTION("by its status") {
    rig.state(InverseStatus{.calibrated = true, .ready = false});
    CHECK(rig.trouble.text() == "Haply device 049D: is not ready, no force; look into Haply Hub");
  }
  SECTION("by its emergency brake") {
    rig.exchange.lock(true);
    rig.state();
    CHECK(
        rig.trouble.text() ==
        "Haply device 049D: its emergency brake is engaged, no force; release it (if it is: engage "
        "it and release it again)");
    rig.exchange.lock(false);
    CHECK_FALSE(rig.mailbox.reading.front().ready);
  }
  CHECK_FALSE(rig.mailbox.reading.front().ready);
  CHECK(rig.turn() == ExchangeRig::of(0.0));
  rig.state(kReadyStatus);
  CHECK(rig.trouble.text().empty());
  CHECK(rig.mailbox.reading.front().ready);
  CHECK(rig.mailbox.reading.front().generation == before + 1);
  CHECK(rig.turn() == ExchangeRig::of(0.0));  // the force is of before
  rig.ask(0.5);
  CHECK(rig.turn() == ExchangeRig::of(0.5));
}

TEST_CASE("exchange: an answer is waited for, a late one for 50 ms; then zero goes out once") {
  ExchangeRig rig;
  rig.ask(1.0);
  CHECK(rig.exchange.next(rig.now_ns));
  rig.exchange.sent(rig.now_ns);
  rig.now_ns += 50 * kMs;
  rig.ask(1.0);
  CHECK_FALSE(rig.exchange.next(rig.now_ns));
  rig.now_ns += kMs;
  CHECK(rig.exchange.next(rig.now_ns) == ExchangeRig::of(0.0));
  rig.exchange.sent(rig.now_ns);
  CHECK_FALSE(rig.exchange.next(rig.now_ns + 1000 * kMs));
  CHECK(rig.trouble.text().find("does not answer") != std::string::npos);
  // On a new connection none of them is answered any more.
  rig.exchange.connect();
  CHECK(rig.exchange.all_answered());
}

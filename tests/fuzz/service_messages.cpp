#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "device_bridge/haply/inverse_events.hpp"
#include "device_bridge/haply/inverse_exchange.hpp"
#include "device_bridge/haply/inverse_messages.hpp"
#include "tests/fuzz/harness.hpp"

namespace irdm::fuzz {

namespace {

// What the servo loop is given of a device, and what the service is told next.
void exchange_with(const haply::ServiceMessage& message, const haply::InverseDevice& device) {
  constexpr std::int64_t kNow = 1'000'000'000;
  haply::InverseMailbox mailbox;
  haply::TroubleText trouble("device");
  haply::InverseReport report;
  haply::InverseExchange exchange(mailbox, trouble, report);
  exchange.begin({.device = device.id, .key = haply::ForceKey::kVector}, device.status);
  exchange.take(device, message.grips, kNow);
  mailbox.reading.receive();
  const haply::InverseReading& reading = mailbox.reading.front();
  expect(reading.tip.allFinite(), "a tip that is taken is finite");
  expect(std::abs(reading.orientation.norm() - 1.0) < 1e-6, "an orientation has norm 1");
  expect(reading.buttons < 8, "a grip has three buttons");
  expect(!reading.ready || trouble.text().empty(), "a device that is ready has no trouble");
  const std::optional<std::string> next = exchange.next(kNow);
  expect(next.has_value(), "a force goes out");
}

void service_text(std::string_view text) {
  try {
    const haply::ServiceMessage told = haply::decode(text);
    for (const haply::InverseDevice& device : told.devices) {
      if (!device.tip) continue;
      expect(device.tip->allFinite(), "a tip that is decoded is finite");
      exchange_with(told, device);
    }
  } catch (const haply::MessageError&) {
  }
}

void service_event(std::string_view text) {
  const std::optional<haply::InverseEvent> told = haply::decode_event(text);
  expect(!told || !told->text.empty(), "an event has words");
}

void service_version(std::string_view text) {
  haply::decode_version(text);
}

}  // namespace

void service_message(Input input) {
  constexpr std::array<void (*)(std::string_view), 3> kKinds = {service_text, service_event,
                                                                service_version};
  if (!input.empty()) kKinds[input[0] % kKinds.size()](text_of(input.subspan(1)));
}

}  // namespace irdm::fuzz

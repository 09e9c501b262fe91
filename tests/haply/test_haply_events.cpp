// The channel of events of services from 3.5 on.
#include <string>

#include "device_bridge/haply/haply_device.hpp"
#include "device_bridge/haply/inverse_events.hpp"
#include "tests/haply/fake_service.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;
using haply::decode_event;
using haply::EventMeaning;

namespace {

std::string event(const std::string& name, const std::string& data = "") {
  return R"({"name":")" + name + R"(","category":"device","level":"warning","data":{)" + data +
         R"(},"message":"in words"})";
}

const std::string kOurs = R"("device_family":"inverse","device_id":"049D")";
const std::string kBrake = R"(,"safety_type":"ebrake_triggered")";
const std::string kRelease = R"(,"safety_type":"ebrake_released")";

bool ready_after_tick(HaplyDevice& device) {
  device.read(0.0);
  device.write({});
  return device.state().ready;
}

// A device that is ready, of a service whose events it listens to.
struct Heard {
  Heard() {
    device.open();
    REQUIRE(
        eventually([&] { return ready_after_tick(device) && service.order("listeners") == "1"; }));
  }
  FakeService service;
  HaplyDevice device{service.settings()};
};

}  // namespace

TEST_CASE("events of the service: those of use have a meaning, others none") {
  CHECK(decode_event(event("device-disconnected", kOurs))->meaning == EventMeaning::kLost);
  CHECK(decode_event(event("device-disconnected", kOurs))->device == "049D");
  const std::string safety = "device-safety-triggered";
  CHECK(decode_event(event(safety, kOurs + kBrake))->meaning == EventMeaning::kLocked);
  CHECK(decode_event(event(safety, kOurs + kRelease))->meaning == EventMeaning::kUnlocked);
  const auto busy = decode_event(event("device-busy"));
  CHECK(busy->meaning == EventMeaning::kNotice);
  CHECK(busy->device.empty());
  CHECK(busy->text == "device-busy: in words");
  CHECK(decode_event(R"({"name":"device-sleep"})")->text == "device-sleep");
  CHECK_FALSE(decode_event(event("device-connected", kOurs)));
  CHECK_FALSE(decode_event(event(safety, kOurs)));
  for (const char* text : {"", "[]", "{", R"({"name":7})", R"({"data":[]})", "null"}) {
    CHECK_FALSE(decode_event(text));
  }
}

TEST_CASE("an emergency brake that is engaged takes the force until it is released") {
  Heard heard;
  heard.service.order("event " + event("device-safety-triggered", kOurs + kBrake));
  CHECK(eventually([&] { return !ready_after_tick(heard.device); }));
  CHECK(eventually([&] {
    return heard.device.trouble().find("its emergency brake is engaged") != std::string::npos;
  }));
  CHECK(heard.device.state().off);
  heard.service.order("event " + event("device-safety-triggered", kOurs + kRelease));
  CHECK(
      eventually([&] { return ready_after_tick(heard.device) && heard.device.trouble().empty(); }));
}

TEST_CASE("a brake that is engaged stays so over a lost connection, and events are heard again") {
  Heard heard;
  heard.service.order("event " + event("device-safety-triggered", kOurs + kBrake));
  CHECK(eventually([&] { return !ready_after_tick(heard.device); }));
  heard.service.order("event");  // their channel breaks, and is opened again
  CHECK(eventually([&] { return heard.service.order("listeners") == "2"; }));
  heard.service.kill();
  CHECK(eventually(
      [&] { return heard.device.trouble().find("no connection") != std::string::npos; }));
  heard.service.start();
  CHECK(eventually([&] {
    return heard.device.trouble().find("its emergency brake is engaged") != std::string::npos;
  }));
  CHECK_FALSE(ready_after_tick(heard.device));
  REQUIRE(eventually([&] { return heard.service.order("listeners") == "1"; }));
  heard.service.order("event " + event("device-safety-triggered", kOurs + kRelease));
  CHECK(eventually([&] { return ready_after_tick(heard.device); }));
}

TEST_CASE("a device that the service has lost has no force, and comes back when it is there") {
  Heard heard;
  heard.service.order("plugged 049D 0");
  heard.service.order("event " + event("device-disconnected", kOurs));
  CHECK(eventually([&] { return !ready_after_tick(heard.device); }));
  heard.service.order("plugged 049D 1");
  CHECK(eventually([&] { return ready_after_tick(heard.device); }));
}

TEST_CASE("an event that tells of a loss alone counts before the states do") {
  Heard heard;
  heard.service.order("event " + event("device-disconnected", kOurs));
  // It is there all the same: a new connection begins, once.
  CHECK(eventually([&] { return !ready_after_tick(heard.device); }));
  CHECK(eventually([&] { return ready_after_tick(heard.device); }));
  CHECK(heard.service.misuses().starts_with("0 "));
}

TEST_CASE("events of another device, and what is no event, change nothing; a notice is told") {
  CapturedLog log;
  Heard heard;
  const std::string other = R"("device_id":"04EA")";
  heard.service.order("event " + event("device-disconnected", other));
  heard.service.order("event " + event("device-safety-triggered", other + kBrake));
  heard.service.order("event hello");
  heard.service.order("event " + event("device-battery-low", R"("device_id":"61576")"));
  const std::uint64_t before = heard.service.told().forces;
  REQUIRE(eventually([&] {
    ready_after_tick(heard.device);
    CHECK(heard.device.trouble().find("brake") == std::string::npos);
    return heard.service.told().forces > before + 50;
  }));
  // They come in order: when this one has an effect, those before had none.
  heard.service.order("event " + event("device-safety-triggered", kOurs + kBrake));
  REQUIRE(eventually([&] { return heard.device.trouble().find("brake") != std::string::npos; }));
  CHECK(heard.service.order("listeners") == "1");  // no new connection
  heard.device.close();
  CHECK_THAT(log.text(), ContainsSubstring("the service says: device-battery-low: in words"));
}

TEST_CASE("a service without the channel of events is used without it") {
  FakeService service;
  haply::InverseSettings settings = service.settings();
  settings.events_port = 1;  // nobody listens there
  HaplyDevice device(settings);
  device.open();
  CHECK(eventually([&] { return ready_after_tick(device); }));
  CHECK(device.trouble().empty());
}

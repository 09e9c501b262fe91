#include <cmath>
#include <limits>

#include "device_bridge/haply/inverse_messages.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::haply;

namespace {

// A state of one device whose parts can be written otherwise.
std::string state_text(const std::string& position, const std::string& status) {
  return R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":)" + position +
         R"(},"status":)" + status + "}]}";
}

const std::string kPosition = R"({"x":0.1,"y":0.2,"z":0.3})";
const std::string kReady = R"({"calibrated":true,"ready":true,"in_use":false})";

}  // namespace

TEST_CASE("a state has the tip in our axes, and what the service says of the device") {
  const ServiceMessage message = decode(state_text(kPosition, kReady));
  CHECK_FALSE(message.session);
  REQUIRE(message.devices.size() == 1);
  const InverseDevice& device = message.devices[0];
  CHECK(device.id == "049D");
  REQUIRE(device.tip);
  CHECK(device.tip->isApprox(Vector3(0.1, 0.3, -0.2)));
  REQUIRE(device.status);
  CHECK(device.status->calibrated);
  CHECK(device.status->ready);
  CHECK(device.status->power_supply);
  CHECK_FALSE(decode(state_text(kPosition, "{}")).devices[0].status);
  CHECK_FALSE(decode(state_text(kPosition, R"({"calibrated":false,"ready":true})"))
                  .devices[0]
                  .status->calibrated);
}

TEST_CASE("the first message of 3.5 has a session and the device's configuration") {
  const ServiceMessage message = decode(
      R"({"session_id":7,"inverse3":[{"device_id":"049D","config":{"type":"inverse3",)"
      R"("handedness":"left","gravity_compensation":{"enabled":false,"scaling_factor":1.0}},)"
      R"("state":{"cursor_position":{"x":0,"y":-0.12,"z":0.15}}}]})");
  CHECK(message.session);
  CHECK(message.devices.at(0).type == "inverse3");
  CHECK(message.devices[0].handedness == "left");
  CHECK(message.devices[0].gravity_compensation == false);
}

TEST_CASE("a grip has an orientation in our axes and a bit for each button") {
  // A quarter turn about the service's z, which is up: our y.
  const ServiceMessage message = decode(
      R"({"wireless_verse_grip":[{"device_id":"1","state":{"orientation":)"
      R"({"w":0.7071068,"x":0,"y":0,"z":0.7071068},"buttons":{"a":true,"b":false,"c":true}}}],)"
      R"("verse_grip":[{"device_id":"2","state":{"button":true,"orientation":{"w":0,"x":0,"y":0,)"
      R"("z":0}}}]})");
  REQUIRE(message.grips.size() == 2);
  REQUIRE(message.grips[0].orientation);
  CHECK((*message.grips[0].orientation * Vector3::UnitX()).isApprox(-Vector3::UnitZ(), 1e-6));
  CHECK((*message.grips[0].orientation * Vector3::UnitY()).isApprox(Vector3::UnitY(), 1e-6));
  CHECK(message.grips[0].buttons == 5);
  CHECK_FALSE(message.grips[1].orientation);
  CHECK(message.grips[1].buttons == 1);
}

TEST_CASE("what is no message of the service is refused, in words") {
  for (const char* text : {"", "garbage", "{\"inverse3\":[", "[1,2]", "\xff\xfe", "null"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(decode(text), MessageError);
  }
  for (const char* text : {R"({"inverse3":{"049D":1}})", R"({"inverse3":[3]})",
                           R"({"inverse3":[{"device_id":"1","state":[]}]})"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(decode(text), MessageError);
  }
  for (const char* number : {"null", "\"0\"", "true", "[]", "{}", "NaN", "Infinity", "1e999"}) {
    CAPTURE(number);
    const std::string position = std::string(R"({"x":)") + number + R"(,"y":0,"z":0})";
    CHECK_THROWS_AS(decode(state_text(position, kReady)), MessageError);
  }
  CHECK_THROWS_WITH(decode(state_text(R"({"x":null,"y":0,"z":0})", kReady)),
                    ContainsSubstring("x is no number"));
  CHECK_THROWS_AS(decode(state_text(R"({"y":0,"z":0})", kReady)), MessageError);
}

TEST_CASE("a force is sent in the service's axes, by the name of its version; none if not finite") {
  CHECK(encode_force("049D", Vector3(1, 2, 3), ForceKey::kVector) ==
        R"({"inverse3":[{"commands":{"set_cursor_force":{"vector":{"x":1.0,"y":-3.0,"z":2.0}}},)"
        R"("device_id":"049D"}]})");
  CHECK_THAT(encode_force("049D", Vector3(1, 2, 3), ForceKey::kValues),
             ContainsSubstring(R"("values":{"x":1.0,"y":-3.0,"z":2.0})"));
  for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    CHECK_THAT(encode_force("049D", Vector3(1, wrong, 3), ForceKey::kVector),
               ContainsSubstring(R"("vector":{"x":0.0,"y":0.0,"z":0.0})"));
  }
  CHECK_THAT(encode_first("049D"), ContainsSubstring(R"("permutation":"XYZ")") &&
                                       ContainsSubstring(R"("x":0.0,"y":0.0,"z":0.0)"));
}

TEST_CASE("the service's version is read from its answer, with an envelope or without") {
  const auto version = decode_version(R"({"project_version":"3.5.0.0"})");
  REQUIRE(version);
  CHECK(version->major == 3);
  CHECK(version->minor == 5);
  CHECK(decode_version(R"({"ok":true,"data":{"project_version":"4.0.1"}})")->major == 4);
  CHECK_FALSE(decode_version("<html>"));
  CHECK_FALSE(decode_version(R"({"project_version":5})"));
}

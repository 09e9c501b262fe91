#include "device_bridge/doctor/judgements.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::doctor;

namespace {

constexpr bool kWanted = true;
constexpr bool kNotWanted = false;

ClockFacts good_clock() {
  return {.source = "tsc",
          .resolution_ns = 1,
          .usual_lateness_ns = 60'000,
          .worst_lateness_ns = 900'000};
}

}  // namespace

TEST_CASE("findings are a line each, with the remedy where there is one") {
  const Findings findings{{Grade::kOk, "clock", "good", ""},
                          {Grade::kWarning, "port", "none", "plug it in"},
                          {Grade::kProblem, "driver", "missing", "install it"}};
  CHECK(to_text(findings) ==
        "ok       clock: good\n"
        "warning  port: none; plug it in\n"
        "problem  driver: missing; install it\n");
  CHECK(count_problems(findings) == 1);
  CHECK(count_problems({}) == 0);
}

TEST_CASE("doctor: a driver that does not load is a problem where a device needs it") {
  CHECK(judge_library("libHD.so", "", kWanted).grade == Grade::kOk);
  const Finding finding =
      judge_library("libHD.so", "OpenHaptics: libHD.so needs libx; install libx", kWanted);
  CHECK(finding.grade == Grade::kProblem);
  CHECK(finding.what == "OpenHaptics: libHD.so needs libx");
  CHECK(finding.remedy == "install libx");
  CHECK(judge_library("libHD.so", "missing", kNotWanted).grade == Grade::kWarning);
}

TEST_CASE("doctor: each port is told, and whether it is permitted") {
  const hd::TouchSystem system{
      .ports = {{"/dev/ttyACM0", "2988:0302", true}, {"/dev/hidraw1", "2988:0304", false}}};
  const Findings findings = judge_ports(system, kWanted);
  REQUIRE(findings.size() == 2);
  CHECK(findings[0].grade == Grade::kOk);
  CHECK_THAT(findings[0].what, ContainsSubstring("2988:0302"));
  CHECK(findings[1].grade == Grade::kProblem);
  CHECK(findings[1].subject == "port /dev/hidraw1");
  CHECK_THAT(findings[1].remedy, ContainsSubstring("udev"));
  CHECK(judge_ports(system, kNotWanted)[1].grade == Grade::kWarning);
  CHECK(judge_ports({}, kWanted).at(0).grade == Grade::kWarning);
  CHECK(judge_ports({}, kNotWanted).at(0).grade == Grade::kOk);
}

TEST_CASE(
    "doctor: devices of Force Dimension are told, with the udev rule of those not permitted") {
  const std::vector<dhd::UsbDevice> devices{{"/dev/bus/usb/001/004", "0403:cb48", true},
                                            {"/dev/bus/usb/001/005", "1451:0402", false}};
  const Findings findings = judge_usb(devices, kWanted);
  REQUIRE(findings.size() == 2);
  CHECK(findings[0].grade == Grade::kOk);
  CHECK_THAT(findings[0].what, ContainsSubstring("0403:cb48"));
  CHECK(findings[1].grade == Grade::kProblem);
  CHECK(findings[1].subject == "usb /dev/bus/usb/001/005");
  CHECK_THAT(findings[1].remedy, ContainsSubstring("/etc/udev/rules.d") &&
                                     ContainsSubstring(dhd::udev_rule("1451:0402")));
  CHECK(judge_usb(devices, kNotWanted)[1].grade == Grade::kWarning);
  CHECK(judge_usb({}, kWanted).at(0).grade == Grade::kWarning);
  CHECK(judge_usb({}, kNotWanted).at(0).grade == Grade::kOk);
}

TEST_CASE("doctor: a device's service is judged by how long it takes to answer") {
  CHECK(judge_service("service", 500, 400'000).grade == Grade::kOk);
  CHECK_THAT(judge_service("service", 500, 400'000).what, ContainsSubstring("500 answers, 99 %"));
  CHECK(judge_service("service", 500, 2'100'000).grade == Grade::kWarning);
  CHECK_FALSE(judge_service("service", 500, 2'100'000).remedy.empty());
  CHECK(judge_service("service", 0, 0).grade == Grade::kWarning);
}

TEST_CASE("doctor: a device's setup is found, missing, another's, or written with commas") {
  const hd::TouchSystem system{
      .folders = {"/c"},
      .setups = {{"Left", "/c/Left.config", false}, {"Right", "/c/Right.config", true}}};
  CHECK(judge_setup(system, "Left").grade == Grade::kOk);
  CHECK(judge_setup(system, "").grade == Grade::kOk);
  CHECK(judge_setup(system, "Right").grade == Grade::kProblem);
  CHECK_THAT(judge_setup(system, "Right").what,
             ContainsSubstring("/c/Right.config has decimal commas"));
  CHECK(judge_setup(system, "Middle").grade == Grade::kProblem);
  CHECK_THAT(judge_setup(system, "Middle").what, ContainsSubstring("only Left, Right"));
  const Finding none = judge_setup({.folders = {"/c", "/d"}}, "Left");
  CHECK(none.grade == Grade::kWarning);
  CHECK_THAT(none.what, ContainsSubstring("/c, /d"));
}

TEST_CASE("doctor: real time that is not permitted weighs as the configuration wants it") {
  const Permission refused{.given = false, .refusal = "Operation not permitted"};
  CHECK(judge_real_time({.given = true}, RealTimeScheduling::kRequire).grade == Grade::kOk);
  CHECK(judge_real_time(refused, RealTimeScheduling::kRequire).grade == Grade::kProblem);
  CHECK(judge_real_time(refused, RealTimeScheduling::kPrefer).grade == Grade::kWarning);
  CHECK(judge_real_time(refused, RealTimeScheduling::kIgnore).grade == Grade::kOk);
  CHECK_THAT(judge_real_time(refused, RealTimeScheduling::kPrefer).remedy,
             ContainsSubstring("rtprio"));
  CHECK(judge_locked_memory({.given = true}, RealTimeScheduling::kRequire).grade == Grade::kOk);
  const Finding memory = judge_locked_memory(refused, RealTimeScheduling::kRequire);
  CHECK(memory.grade == Grade::kProblem);
  CHECK(judge_locked_memory(refused, RealTimeScheduling::kPrefer).grade == Grade::kWarning);
  CHECK_THAT(memory.what, ContainsSubstring("64 MiB cannot be locked: Operation not permitted"));
  CHECK(judge_locked_memory(refused, RealTimeScheduling::kIgnore).grade == Grade::kOk);
}

TEST_CASE("doctor: clocks that are coarse or slow, and wake-ups that are late") {
  CHECK(judge_clock_source(good_clock()).grade == Grade::kOk);
  ClockFacts clock = good_clock();
  clock.source = "hpet";
  CHECK(judge_clock_source(clock).grade == Grade::kWarning);
  clock.source.clear();
  CHECK_THAT(judge_clock_source(clock).what, ContainsSubstring("unknown source"));
  clock.resolution_ns = 4'000'000;
  CHECK(judge_clock_source(clock).grade == Grade::kProblem);
  clock.resolution_ns = 0;
  CHECK(judge_clock_source(clock).grade == Grade::kProblem);

  CHECK(judge_wakeup(good_clock()).grade == Grade::kOk);
  CHECK_THAT(judge_wakeup(good_clock()).what,
             ContainsSubstring("0.060 ms as a rule, 0.900 ms at worst"));
  clock = good_clock();
  clock.worst_lateness_ns = 2'000'001;
  CHECK(judge_wakeup(clock).grade == Grade::kWarning);
  clock.usual_lateness_ns = 500'001;
  CHECK(judge_wakeup(clock).grade == Grade::kProblem);
}

TEST_CASE("doctor: a server that welcomes, refuses, is silent, or is not there") {
  const auto judge = [](const ServerFacts& facts) { return judge_server(facts, "h:1"); };
  CHECK(judge({.connects = true, .welcomes = true}).grade == Grade::kOk);
  const Finding away = judge({.words = "no connection: Connection refused"});
  CHECK(away.grade == Grade::kProblem);
  CHECK(away.subject == "server h:1");
  CHECK_THAT(away.remedy, ContainsSubstring("start irdm-server"));
  const Finding refused =
      judge({.connects = true, .words = "h:1: the server refuses: 3 styluses; change them"});
  CHECK(refused.grade == Grade::kProblem);
  CHECK(refused.remedy == "change them");
  const Finding silent = judge({.connects = true});
  CHECK(silent.grade == Grade::kProblem);
  CHECK_THAT(silent.what, ContainsSubstring("does not welcome"));
}

#include <fstream>

#include "common/config/toml_reader.hpp"
#include "common/error.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/commission/report.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::commission;
using namespace irdm::test;

namespace {

Report good_report() {
  return {.type = "openhaptics",
          .name = "Left",
          .device = "Touch, serial number \"1\\2\"",
          .date = "2026-11-27",
          .measured = {.position_noise = 1.234e-5, .max_force = 3.3},
          .steps = {{"driver", Verdict::kPassed, "no problem"},
                    {"axis right", Verdict::kPassed, "right is +x"}}};
}

/// Reads a report from a file with this text.
Report load(const std::string& text) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "commission.toml";
  std::ofstream(path) << text;
  return load_report(path);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("commission: a report is read as it was written") {
  const Report written = good_report();
  const Report read = load(to_toml(written, "commission-Left.toml"));
  CHECK(read.type == written.type);
  CHECK(read.name == written.name);
  CHECK(read.device == written.device);
  CHECK(read.date == written.date);
  CHECK(read.measured.position_noise.value() == Approx(1.234e-5));
  CHECK(read.measured.max_force.value() == Approx(3.3));
  CHECK_FALSE(read.measured.coupling_stiffness.has_value());
  CHECK(read.steps.size() == 2);
  CHECK(read.steps[1].words == "right is +x");
  CHECK(read.signed_off());
}

TEST_CASE("commission: a report that is not signed off is refused with the step") {
  for (const Verdict verdict : {Verdict::kFailed, Verdict::kStopped, Verdict::kNotReached}) {
    Report report = good_report();
    report.steps[1].verdict = verdict;
    CHECK_FALSE(report.signed_off());
    CHECK_THROWS_WITH(load(to_toml(report, "x.toml")), ContainsSubstring("device.step.verdict") ||
                                                           ContainsSubstring("not signed off"));
  }
}

TEST_CASE("commission: a report that is none, or incomplete, is refused with the reason") {
  const std::string good = to_toml(good_report(), "x.toml");
  CHECK_THROWS_WITH(load(""), ContainsSubstring("is no report of irdm-bridge commission"));
  CHECK_THROWS_WITH(load_report("/nowhere.toml"), ContainsSubstring("/nowhere.toml"));
  CHECK_THROWS_WITH(load(replaced(good, "max_force = 3.3", "")), ContainsSubstring("max_force"));
  CHECK_THROWS_WITH(load(replaced(good, "date = \"2026-11-27\"", "")), ContainsSubstring("date"));
  CHECK_THROWS_WITH(load(replaced(good, "max_force = 3.3", "max_force = \"x\"")),
                    ContainsSubstring("max_force"));
  CHECK_THROWS_WITH(load(replaced(good, "[device.measured]", "[device.other]")),
                    ContainsSubstring("measured"));
  CHECK_THROWS_WITH(load(replaced(good, "verdict = \"passed\"", "verdict = \"fine\"")),
                    ContainsSubstring("verdict"));
  CHECK_THROWS_WITH(load(good.substr(0, good.find("[[device.step]]"))),
                    ContainsSubstring("has no steps"));
}

TEST_CASE("commission: the key `commissioned` names a report beside the configuration") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "left.toml") << to_toml(good_report(), "left.toml");
  const auto path = folder.path() / "bridge.toml";
  std::ofstream(path) << "[[device]]\ntype = \"openhaptics\"\ncommissioned = \"left.toml\"\n";
  const BridgeConfig config = load_bridge_config(path);
  REQUIRE(config.devices[0].commissioned.has_value());
  CHECK(config.devices[0].commissioned->device == good_report().device);
  std::ofstream(path) << "[[device]]\ntype = \"openhaptics\"\ncommissioned = \"none.toml\"\n";
  CHECK_THROWS_WITH(load_bridge_config(path), ContainsSubstring("none.toml"));
}

TEST_CASE("commission: the table of a report can be pasted into a configuration") {
  const std::string text = to_toml(good_report(), "left.toml");
  const std::size_t from = text.find("[[device]]");
  const std::string table = text.substr(from, text.find("[device.report]") - from);
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "left.toml") << text;
  const auto path = folder.path() / "bridge.toml";
  std::ofstream(path) << table;
  CHECK(load_bridge_config(path).devices[0].name == "Left");
}

#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "device_bridge/commission/plan.hpp"
#include "device_bridge/commission/report.hpp"
#include "device_bridge/commission/step_runner.hpp"
#include "tests/support/catch.hpp"

namespace irdm::test {

/// All steps, until one does not pass. What needs no ticks counts as passed.
/// @param ask is given what a step asks for  @param tick makes one of the servo loop
template <typename Ask, typename Tick>
commission::Report play_plan(const commission::PlanSettings& settings,
                             commission::StepRunner& runner, Ask ask, Tick tick) {
  using commission::Verdict;
  commission::Report report;
  report.date = "2026-11-27";
  report.steps.push_back({"driver", Verdict::kPassed, "no problem found"});
  for (const auto& step : commission::make_plan(settings)) {
    ask(step->request().order);
    runner.begin(*step);
    while (!runner.ended().consume()) tick();
    report.steps.push_back(commission::judged(*step, report.measured));
    if (report.steps.back().verdict != Verdict::kPassed) return report;
  }
  if (settings.simulated) return report;
  report.steps.push_back(
      {"stop of a killed bridge", Verdict::kPassed, "told by a simulated person"});
  return report;
}

/// Its name and what was said of it.
inline std::string last_step(const commission::Report& report) {
  return report.steps.back().step + ": " + report.steps.back().words;
}

/// That examples/commission/NAME is a report like this one. With $IRDM_WRITE_EXAMPLES it is made
/// anew.
inline void check_example(const commission::Report& report, const std::string& name) {
  const auto path = std::filesystem::path(IRDM_SOURCE_DIR) / "examples/commission" / name;
  if (std::getenv("IRDM_WRITE_EXAMPLES") != nullptr) std::ofstream(path) << to_toml(report, name);
  const commission::Report example = commission::load_report(path);
  CHECK(example.type == report.type);
  CHECK(example.device == report.device);
  CHECK(example.measured.max_force.value() ==
        Approx(report.measured.max_force.value()).epsilon(0.1));
  CHECK(example.measured.coupling_stiffness.has_value());
  REQUIRE(example.steps.size() == report.steps.size());
  for (std::size_t i = 0; i < report.steps.size(); ++i) {
    CHECK(example.steps[i].step == report.steps[i].step);
  }
}

}  // namespace irdm::test

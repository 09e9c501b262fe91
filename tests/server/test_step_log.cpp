#include "server/blackbox/step_log.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

constexpr std::int64_t kStepNs = 2'000'000;

/// One stylus, which touches.
StepRow touching(std::int64_t time_ns = 0) {
  StepRow row;
  row.time_ns = time_ns;
  row.stylus_count = 1;
  row.stylus[0].present = true;
  row.stylus[0].contact = ContactState::kTouching;
  return row;
}

/// The fault in `row` after a step in which the stylus touched, or was free; empty: none.
std::string fault_in(const StepRow& row, bool touched = true) {
  StepLog log;
  StepRow before = touching();
  if (!touched) before.stylus[0].contact = ContactState::kFree;
  log.put(before);
  CHECK_FALSE(log.take());
  log.put(row);
  const std::optional<Fault> fault = log.take();
  return fault ? fault->kind : "";
}

}  // namespace

TEST_CASE("step log: a step without a solution is a fault, once") {
  StepRow row = touching(kStepNs);
  CHECK(fault_in(row).empty());
  row.solved = false;
  CHECK(fault_in(row) == "force step without a finite solution");
  StepLog log;
  log.put(row);
  CHECK(log.take());
  log.put(row);
  CHECK_FALSE(log.take());
}

TEST_CASE("step log: steps that stop coming are a fault in contact, unless the run was paused") {
  CHECK(fault_in(touching(StepLog::kLongestPauseNs)).empty());
  CHECK(fault_in(touching(StepLog::kLongestPauseNs + 1)) == "force steps stopped in contact");
  CHECK(fault_in(touching(StepLog::kLongestPauseNs + 1), false).empty());
  StepRow continued = touching(StepLog::kLongestPauseNs + 1);
  continued.continued = true;
  continued.stylus[0].present = false;  // the first step after a pause is made without it
  CHECK(fault_in(continued).empty());
}

TEST_CASE("step log: a stylus that is gone in contact is a fault, unless it said goodbye") {
  StepRow gone = touching(kStepNs);
  gone.stylus[0].present = false;
  CHECK(fault_in(gone) == "stylus lost in contact");
  CHECK(fault_in(gone, false).empty());
  gone.stylus[0].left = true;
  CHECK(fault_in(gone).empty());
}

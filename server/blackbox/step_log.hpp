#pragma once

#include "common/blackbox/row_log.hpp"
#include "server/blackbox/step_row.hpp"

namespace irdm {

/// Every force step. Faults are a step without a finite solution, a stylus that is gone without a
/// word while it touches, and steps that stop coming while one does.
class StepLog final : public RowLog<StepRow> {
 public:
  static constexpr std::size_t kCapacity = 1024;
  /// No bridge shows a force that is older than that.
  static constexpr std::int64_t kLongestPauseNs = 50'000'000;

  StepLog() : RowLog(kCapacity) {}
  void write(hdf5::File& file, std::int64_t origin_ns) const override;

 private:
  std::optional<Fault> look(const StepRow& row) override;

  StepRow last_;
};

}  // namespace irdm

#pragma once

#include <array>
#include <cstdint>

#include "common/blackbox/row_log.hpp"
#include "common/geometry.hpp"
#include "common/stylus.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// One force step, as the black box keeps it.
struct StepRow {
  struct Stylus {
    bool present = false;
    bool left = false;                ///< not present because its bridge said goodbye
    bool predicts = false;            ///< its bridge solves the contact
    std::uint64_t sequence = 0;       ///< of the sample that was taken
    std::int64_t sample_time_ns = 0;  ///< of that sample, the bridge's clock
    std::uint32_t buttons = 0;
    int object = -1;
    ContactState contact = ContactState::kFree;
    Vector3 tip = Vector3::Zero();    ///< [m], W
    Vector3 proxy = Vector3::Zero();  ///< [m], W
    Vector3 force = Vector3::Zero();  ///< on the stylus [N], W
  };

  std::int64_t time_ns = 0;      ///< when the step began, monotonic_ns()
  std::int64_t late_ns = 0;      ///< by how much that was too late
  std::int64_t duration_ns = 0;  ///< of the step
  std::uint64_t force_step = 0;  ///< k
  std::uint64_t missed = 0;      ///< steps that were left out so far
  bool continued = false;        ///< the run was paused before
  bool reset = false;
  bool solved = true;     ///< every contact problem had a finite solution
  double residual = 0.0;  ///< the largest of the objects [m]
  int stylus_count = 0;
  std::array<Stylus, kMaxStyluses> stylus = {};
};

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

#pragma once

#include <map>

#include "common/blackbox/row_log.hpp"
#include "device_bridge/blackbox/tick_row.hpp"

namespace irdm {

/// Every tick of every stylus. Faults are a device that fails or is lost, a latched fault of the
/// safety filter, and a connection that is lost while a force is felt.
class TickLog final : public RowLog<TickRow> {
 public:
  static constexpr std::size_t kCapacity = 4096;  ///< 1 s of four styluses at 1 kHz

  TickLog() : RowLog(kCapacity) {}
  void write(hdf5::File& file, std::int64_t origin_ns) const override;

 private:
  std::optional<Fault> look(const TickRow& row) override;

  std::map<int, TickRow> last_;  ///< by stylus
};

}  // namespace irdm

#include "server/blackbox/step_log.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/blackbox/row_log.hpp"

namespace irdm {
namespace {

bool touches(const StepRow::Stylus& stylus) {
  return stylus.present && stylus.contact != ContactState::kFree;
}

bool any_touches(const StepRow& row) {
  return std::any_of(row.stylus.begin(), row.stylus.end(), touches);
}

void write_stylus(hdf5::File& file, std::size_t s, const std::vector<const StepRow*>& rows,
                  std::int64_t origin_ns) {
  ColumnGroup<StepRow> columns(file, "/step/stylus/" + std::to_string(s), rows);
  const auto of = [s](const StepRow& row) -> const StepRow::Stylus& { return row.stylus[s]; };
  columns.number<std::uint8_t>("present", "", [&](const StepRow& row) { return of(row).present; });
  columns.number<std::uint8_t>("predicts", "",
                               [&](const StepRow& row) { return of(row).predicts; });
  columns.number<std::uint64_t>("sequence", "",
                                [&](const StepRow& row) { return of(row).sequence; });
  // On the bridge's clock, which on one machine is ours.
  columns.time("sample_time", origin_ns,
               [&](const StepRow& row) { return of(row).sample_time_ns; });
  columns.number<std::int32_t>("buttons", "", [&](const StepRow& row) { return of(row).buttons; });
  columns.number<std::int32_t>("object", "", [&](const StepRow& row) { return of(row).object; });
  columns.number<std::uint8_t>("contact", "", [&](const StepRow& row) { return of(row).contact; });
  columns.vector("tip", "m", [&](const StepRow& row) { return of(row).tip; });
  columns.vector("proxy", "m", [&](const StepRow& row) { return of(row).proxy; });
  columns.vector("force", "N", [&](const StepRow& row) { return of(row).force; });
}

}  // namespace

std::optional<Fault> StepLog::look(const StepRow& row) {
  const StepRow before = std::exchange(last_, row);
  const bool first = before.stylus_count == 0;
  if (!row.solved && before.solved) {
    return Fault{row.time_ns, "force step without a finite solution",
                 "step " + std::to_string(row.force_step)};
  }
  const std::int64_t pause_ns = row.time_ns - before.time_ns;
  if (!first && !row.continued && pause_ns > kLongestPauseNs && any_touches(before)) {
    return Fault{
        row.time_ns, "force steps stopped in contact",
        std::to_string(pause_ns / 1'000'000) + " ms before step " + std::to_string(row.force_step)};
  }
  for (std::size_t s = 0; s < row.stylus.size(); ++s) {
    if (row.continued || row.stylus[s].present || row.stylus[s].left) continue;
    if (touches(before.stylus[s])) {
      return Fault{row.time_ns, "stylus lost in contact", "stylus " + std::to_string(s)};
    }
  }
  return std::nullopt;
}

void StepLog::write(hdf5::File& file, std::int64_t origin_ns) const {
  std::vector<const StepRow*> all;
  int styluses = 0;
  for (const StepRow& row : rows()) {
    all.push_back(&row);
    styluses = std::max(styluses, row.stylus_count);
  }
  ColumnGroup<StepRow> columns(file, "/step", all);
  columns.time("time", origin_ns, [](const StepRow& row) { return row.time_ns; });
  columns.number<double>("late", "s", [](const StepRow& row) { return 1e-9 * row.late_ns; });
  columns.number<double>("duration", "s",
                         [](const StepRow& row) { return 1e-9 * row.duration_ns; });
  columns.number<std::uint64_t>("force_step", "",
                                [](const StepRow& row) { return row.force_step; });
  columns.number<std::uint64_t>("missed", "", [](const StepRow& row) { return row.missed; });
  columns.number<std::uint8_t>("reset", "", [](const StepRow& row) { return row.reset; });
  columns.number<std::uint8_t>("solved", "", [](const StepRow& row) { return row.solved; });
  columns.number<double>("residual", "m", [](const StepRow& row) { return row.residual; });
  for (std::size_t s = 0; s < static_cast<std::size_t>(styluses); ++s) {
    write_stylus(file, s, all, origin_ns);
  }
  file.write_attribute("/step", "lost", static_cast<std::int64_t>(lost()));
}

}  // namespace irdm

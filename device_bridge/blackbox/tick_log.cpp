#include "device_bridge/blackbox/tick_log.hpp"

#include <utility>
#include <vector>

#include "common/blackbox/row_log.hpp"

namespace irdm {
namespace {

bool felt(const TickRow& row) {
  return !(row.force.isZero(0.0) && row.torque.isZero(0.0)) &&
         (row.state == FilterState::kEngaged || row.state == FilterState::kFading);
}

// What is wrong now and was not before; empty: nothing.
std::string news(const TickRow& before, const TickRow& now) {
  if (now.device.lost && !before.device.lost) return "device lost";
  if (now.device.failed && !before.device.failed) return "device failed";
  if (now.state == FilterState::kFault && before.state != FilterState::kFault) {
    return "fault of the safety filter";
  }
  const bool lost = before.linked && (!now.linked || now.session != before.session);
  if (lost && !now.server_ended && felt(before)) return "connection lost with a force";
  return "";
}

void write_input(ColumnGroup<TickRow>& columns, std::int64_t origin_ns) {
  columns.time("time", origin_ns, [](const TickRow& row) { return row.time_ns; });
  columns.number<double>("late", "s", [](const TickRow& row) { return 1e-9 * row.late_ns; });
  columns.number<std::uint8_t>("linked", "", [](const TickRow& row) { return row.linked; });
  columns.number<std::uint64_t>("session", "", [](const TickRow& row) { return row.session; });
  columns.vector("reading", "m", [](const TickRow& row) { return row.reading; });
  columns.number<std::uint8_t>("device_ready", "",
                               [](const TickRow& row) { return row.device.ready; });
  columns.number<std::uint8_t>("device_failed", "",
                               [](const TickRow& row) { return row.device.failed; });
  columns.number<std::uint8_t>("device_lost", "",
                               [](const TickRow& row) { return row.device.lost; });
  columns.number<std::uint8_t>("device_off", "", [](const TickRow& row) { return row.device.off; });
  columns.number<double>("motor_temperature", "",
                         [](const TickRow& row) { return row.device.motor_temperature; });
  columns.number<std::uint64_t>("sequence", "",
                                [](const TickRow& row) { return row.sample.sequence; });
  columns.number<std::int32_t>("buttons", "",
                               [](const TickRow& row) { return row.sample.buttons; });
  columns.vector("tip", "m", [](const TickRow& row) { return row.sample.tip; });
}

void write_force(ColumnGroup<TickRow>& columns, std::int64_t origin_ns) {
  columns.number<std::uint8_t>("predicts", "", [](const TickRow& row) { return row.predicts; });
  columns.number<std::uint64_t>("force_step", "",
                                [](const TickRow& row) { return row.force_step; });
  columns.number<std::uint8_t>("any_demand", "", [](const TickRow& row) { return row.demand.any; });
  columns.time("demand_time", origin_ns,
               [](const TickRow& row) { return row.demand.sample_time_ns; });
  columns.number<double>("horizon", "s",
                         [](const TickRow& row) { return 1e-9 * row.demand.horizon_ns; });
  columns.number<std::uint8_t>("contact", "",
                               [](const TickRow& row) { return row.demand.contact; });
  columns.vector("demand", "N", [](const TickRow& row) { return row.demand.force; });
  columns.vector("demand_torque", "N m", [](const TickRow& row) { return row.demand.torque; });
  columns.vector("normal", "", [](const TickRow& row) { return row.demand.normal; });
  columns.number<std::uint8_t>("state", "", [](const TickRow& row) { return row.state; });
  columns.number<std::uint64_t>("readings_unused", "",
                                [](const TickRow& row) { return row.counts.readings; });
  columns.number<std::uint64_t>("demands_unused", "",
                                [](const TickRow& row) { return row.counts.demands; });
  columns.number<std::uint64_t>("trips", "", [](const TickRow& row) { return row.counts.trips; });
  columns.number<std::uint64_t>("faults", "", [](const TickRow& row) { return row.counts.faults; });
  columns.number<double>("success_rate", "", [](const TickRow& row) { return row.success_rate; });
  columns.number<double>("port_energy", "J", [](const TickRow& row) { return row.port_energy; });
  columns.number<double>("gain", "", [](const TickRow& row) { return row.gain; });
  columns.number<double>("warmth", "", [](const TickRow& row) { return row.warmth; });
  columns.vector("force", "N", [](const TickRow& row) { return row.force; });
  columns.vector("torque", "N m", [](const TickRow& row) { return row.torque; });
}

}  // namespace

std::optional<Fault> TickLog::look(const TickRow& row) {
  const TickRow before = std::exchange(last_[row.stylus], row);
  const std::string what = news(before, row);
  if (what.empty()) return std::nullopt;
  return Fault{row.time_ns, what, "stylus " + std::to_string(row.stylus)};
}

void TickLog::write(hdf5::File& file, std::int64_t origin_ns) const {
  std::map<int, std::vector<const TickRow*>> by_stylus;
  for (const TickRow& row : rows()) by_stylus[row.stylus].push_back(&row);
  for (auto& [stylus, own] : by_stylus) {
    ColumnGroup<TickRow> columns(file, "/tick/" + std::to_string(stylus), std::move(own));
    write_input(columns, origin_ns);
    write_force(columns, origin_ns);
  }
  if (by_stylus.empty()) file.create_group("/tick");
  file.write_attribute("/tick", "lost", static_cast<std::int64_t>(lost()));
}

}  // namespace irdm

#include "device_bridge/commission/report.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include "common/config/toml_reader.hpp"
#include "common/error.hpp"

namespace irdm::commission {
namespace {

struct QuantityKey {
  const char* key;
  Measured::Quantity Measured::*quantity;
  const char* unit;
};

constexpr std::array kQuantities{
    QuantityKey{"position_noise", &Measured::position_noise, "m"},
    QuantityKey{"velocity_noise", &Measured::velocity_noise, "m/s"},
    QuantityKey{"rate", &Measured::rate, "Hz"},
    QuantityKey{"jitter", &Measured::jitter, "s"},
    QuantityKey{"readings", &Measured::readings, "Hz"},
    QuantityKey{"max_force", &Measured::max_force, "N"},
    QuantityKey{"stop_button", &Measured::stop_button, "s"},
    QuantityKey{"stop_link", &Measured::stop_link, "s"},
    QuantityKey{"stop_cable", &Measured::stop_cable, "s"},
    QuantityKey{"stop_kill", &Measured::stop_kill, "s"},
    QuantityKey{"wall_stiffness", &Measured::wall_stiffness, "N/m"},
    QuantityKey{"coupling_stiffness", &Measured::coupling_stiffness, "N/m"},
};

constexpr std::array<const char*, 4> kVerdicts{"passed", "failed", "stopped", "not reached"};

const char* word(Verdict verdict) {
  return kVerdicts.at(static_cast<std::size_t>(verdict));
}

std::string number(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}

// A basic string of TOML. What is no printable character of ASCII is of no use in it.
std::string quoted(const std::string& words) {
  std::string text = "\"";
  for (const char letter : words) {
    if (letter == '"' || letter == '\\') text += '\\';
    text += letter >= ' ' && letter <= '~' ? letter : '?';
  }
  return text + '"';
}

Verdict read_verdict(TomlTable& table) {
  const std::vector<std::string> words(kVerdicts.begin(), kVerdicts.end());
  const std::string word = table.choice("verdict", words, words.back());
  return static_cast<Verdict>(std::find(words.begin(), words.end(), word) - words.begin());
}

Measured read_measured(TomlTable table) {
  constexpr double kMost = 1e9;
  Measured measured;
  for (const QuantityKey& entry : kQuantities) {
    if (table.has(entry.key)) {
      measured.*entry.quantity = table.number(entry.key, between(0.0, kMost));
    }
  }
  if (!measured.max_force) {
    table.fail("max_force", "is missing", "run irdm-bridge commission again");
  }
  table.finish();
  return measured;
}

Report read_report(TomlTable table) {
  Report report;
  report.type = table.text("type");
  report.name = table.text("name", "");
  table.text("commissioned", "");  // for the configuration that this is pasted into
  TomlTable head = table.table("report", true);
  report.device = head.text("device");
  report.date = head.text("date");
  head.finish();
  TomlTable measured = table.table("measured", true);
  for (TomlTable& step : table.tables("step")) {
    report.steps.push_back({step.text("name"), read_verdict(step), step.text("words", "")});
    step.finish();
    const StepRecord& record = report.steps.back();
    if (record.verdict == Verdict::kPassed) continue;
    step.fail("verdict", "is '" + std::string(word(record.verdict)) + "': not signed off",
              "run irdm-bridge commission until all steps pass, or remove the key `commissioned`: "
              "at most 1 N then");
  }
  report.measured = read_measured(std::move(measured));
  table.finish();
  return report;
}

}  // namespace

bool Report::signed_off() const noexcept {
  return !steps.empty() && std::all_of(steps.begin(), steps.end(), [](const StepRecord& record) {
    return record.verdict == Verdict::kPassed;
  });
}

std::string to_text(const Report& report) {
  std::ostringstream text;
  text << "device: " << report.device << ", " << report.date << ": "
       << (report.signed_off() ? "signed off" : "not signed off") << '\n';
  for (const auto& [step, verdict, words] : report.steps) {
    text << word(verdict) << ": " << step << (words.empty() ? "" : ": " + words) << '\n';
  }
  return text.str();
}

std::string to_toml(const Report& report, const std::string& file) {
  std::ostringstream text;
  std::istringstream lines(to_text(report));
  text << "# irdm-bridge commission\n";
  for (std::string line; std::getline(lines, line);) text << "# " << line << '\n';
  text << "\n[[device]]  # into BRIDGE.toml, this table only\ntype = " << quoted(report.type)
       << "\nname = " << quoted(report.name) << "\ncommissioned = " << quoted(file)
       << "\n\n[device.report]\ndevice = " << quoted(report.device)
       << "\ndate = " << quoted(report.date) << "\n\n[device.measured]\n";
  for (const auto& [key, quantity, unit] : kQuantities) {
    const Measured::Quantity& value = report.measured.*quantity;
    if (value) text << key << " = " << number(*value) << "  # " << unit << '\n';
  }
  for (const auto& [step, verdict, words] : report.steps) {
    text << "\n[[device.step]]\nname = " << quoted(step) << "\nverdict = " << quoted(word(verdict))
         << "\nwords = " << quoted(words) << '\n';
  }
  return text.str();
}

Report load_report(const std::filesystem::path& path) {
  TomlTable root = TomlTable::parse_file(path);
  std::vector<TomlTable> devices = root.tables("device");
  if (devices.size() != 1) {
    throw Error(path.string(), "is no report of irdm-bridge commission",
                "name the file that it wrote");
  }
  root.finish();
  Report report = read_report(std::move(devices.front()));
  if (report.steps.empty()) {
    throw Error(path.string(), "has no steps", "run irdm-bridge commission again");
  }
  return report;
}

}  // namespace irdm::commission

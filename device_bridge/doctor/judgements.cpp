#include "device_bridge/doctor/judgements.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "common/realtime/clock.hpp"
#include "device_bridge/openhaptics/hd_error.hpp"

namespace irdm::doctor {
namespace {

const char* word(Grade grade) {
  switch (grade) {
    case Grade::kOk:
      return "ok       ";
    case Grade::kWarning:
      return "warning  ";
    case Grade::kProblem:
      break;
  }
  return "problem  ";
}

}  // namespace

std::string to_text(const Findings& findings) {
  std::string text;
  for (const auto& [grade, subject, what, remedy] : findings) {
    text += word(grade) + subject + ": " + what + (remedy.empty() ? "" : "; " + remedy) + '\n';
  }
  return text;
}

int count_problems(const Findings& findings) {
  return static_cast<int>(
      std::count_if(findings.begin(), findings.end(),
                    [](const Finding& finding) { return finding.grade == Grade::kProblem; }));
}

}  // namespace irdm::doctor

namespace irdm::doctor {
namespace {

// Of ticks that are a millisecond apart.
constexpr std::int64_t kLateNs = 500'000;
constexpr std::int64_t kVeryLateNs = 2'000'000;
constexpr std::int64_t kCoarseNs = 100'000;

Grade missing(bool wanted) {
  return wanted ? Grade::kProblem : Grade::kWarning;
}

std::string milliseconds(std::int64_t ns) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3f ms",
                static_cast<double>(ns) / static_cast<double>(kNanosecondsPerMillisecond));
  return text.data();
}

// Message and remedy of an Error, whose last part is the remedy.
Finding from_error(Grade grade, const std::string& subject, const std::string& error) {
  const std::size_t cut = error.rfind("; ");
  if (cut == std::string::npos) return {grade, subject, error, ""};
  return {grade, subject, error.substr(0, cut), error.substr(cut + 2)};
}

}  // namespace

Finding judge_library(const std::string& library, const std::string& failure, bool wanted) {
  if (failure.empty()) return {Grade::kOk, "driver", library + " loads", ""};
  return from_error(missing(wanted), "driver", failure);
}

Findings judge_ports(const hd::TouchSystem& system, bool wanted) {
  Findings findings;
  for (const auto& [path, usb_id, permitted] : system.ports) {
    const std::string subject = "port " + path;
    if (permitted) {
      findings.push_back({Grade::kOk, subject, "USB " + usb_id + ", permitted", ""});
    } else {
      findings.push_back(
          {missing(wanted), subject, "USB " + usb_id + ", not permitted", hd::kPermissionRemedy});
    }
  }
  if (!findings.empty()) return findings;
  const std::string what = "no device of 3D Systems is on USB";
  if (!wanted) return {{Grade::kOk, "port", what, ""}};
  return {{Grade::kWarning, "port", what, "check power and cable, unless it is on another bus"}};
}

Findings judge_usb(const std::vector<dhd::UsbDevice>& devices, bool wanted) {
  Findings findings;
  for (const auto& [node, usb_id, permitted] : devices) {
    const std::string subject = "usb " + node;
    if (permitted) {
      findings.push_back({Grade::kOk, subject, usb_id + ", permitted", ""});
    } else {
      findings.push_back({missing(wanted), subject, usb_id + ", not permitted",
                          "write to /etc/udev/rules.d/60-forcedimension.rules, and plug the device "
                          "in again: " +
                              dhd::udev_rule(usb_id)});
    }
  }
  if (!findings.empty()) return findings;
  const std::string what = "no device of Force Dimension is on USB";
  if (!wanted) return {{Grade::kOk, "usb", what, ""}};
  return {{Grade::kWarning, "usb", what, "check power and cable, unless it is on another bus"}};
}

Finding judge_setup(const hd::TouchSystem& system, const std::string& name) {
  const std::string subject = name.empty() ? "setup" : "setup of '" + name + "'";
  const hd::DeviceSetup* const setup = hd::find_setup(system, name);
  if (setup != nullptr && setup->decimal_comma) {
    return {Grade::kProblem, subject, setup->file.string() + " has decimal commas",
            hd::kCommaRemedy};
  }
  if (setup != nullptr) return {Grade::kOk, subject, setup->file.string(), ""};
  const std::string remedy = "set the device up with the vendor's Touch_Setup";
  if (system.setups.empty()) {
    std::string folders;
    for (const auto& folder : system.folders) {
      folders += (folders.empty() ? "" : ", ") + folder.string();
    }
    return {Grade::kWarning, subject, "none is found in " + folders, remedy};
  }
  if (!name.empty()) {
    return {Grade::kProblem, subject, "not found, only " + hd::setup_names(system),
            "correct `name` in the configuration, or " + remedy};
  }
  return {Grade::kOk, subject, "found " + hd::setup_names(system), ""};
}

Finding judge_real_time(const Permission& permission, RealTimeScheduling wanted) {
  const std::string subject = "real-time priority";
  if (permission.given) return {Grade::kOk, subject, "permitted", ""};
  if (wanted == RealTimeScheduling::kIgnore) {
    return {Grade::kOk, subject, "not permitted, and not asked for", ""};
  }
  return {missing(wanted == RealTimeScheduling::kRequire), subject, "not permitted",
          "add `@GROUP - rtprio 90` for a group of yours to /etc/security/limits.d, log in again"};
}

Finding judge_locked_memory(const Permission& permission, RealTimeScheduling wanted) {
  const std::string subject = "locked memory";
  const std::string size = std::to_string(kLockedBytes >> 20) + " MiB";
  if (permission.given) return {Grade::kOk, subject, size + " can be locked", ""};
  if (wanted == RealTimeScheduling::kIgnore) {
    return {Grade::kOk, subject, "not permitted, and not asked for", ""};
  }
  return {missing(wanted == RealTimeScheduling::kRequire), subject,
          size + " cannot be locked: " + permission.refusal,
          "add `@GROUP - memlock unlimited` for a group of yours to /etc/security/limits.d, log in "
          "again"};
}

Finding judge_clock_source(const ClockFacts& clock) {
  const std::string subject = "clock";
  const std::string source = clock.source.empty() ? "unknown source" : "source " + clock.source;
  const std::string what = source + ", resolution " + std::to_string(clock.resolution_ns) + " ns";
  if (clock.resolution_ns <= 0 || clock.resolution_ns > kCoarseNs) {
    return {Grade::kProblem, subject, what, "use a kernel with high-resolution timers"};
  }
  const std::array<std::string, 3> slow{"hpet", "acpi_pm", "jiffies"};
  if (std::find(slow.begin(), slow.end(), clock.source) != slow.end()) {
    return {Grade::kWarning, subject, what + ", slow to read",
            "see why the kernel does not trust tsc (dmesg), or boot with clocksource=tsc"};
  }
  return {Grade::kOk, subject, what, ""};
}

Finding judge_wakeup(const ClockFacts& clock) {
  const std::string subject = "wake-up";
  const std::string what = "late by " + milliseconds(clock.usual_lateness_ns) + " as a rule, " +
                           milliseconds(clock.worst_lateness_ns) + " at worst";
  if (clock.usual_lateness_ns > kLateNs) {
    return {Grade::kProblem, subject, what, "use a kernel with high-resolution timers"};
  }
  if (clock.worst_lateness_ns > kVeryLateNs) {
    return {Grade::kWarning, subject, what,
            "run less beside it, switch power saving off, or use a real-time kernel"};
  }
  return {Grade::kOk, subject, what, ""};
}

Finding judge_service(const std::string& subject, std::uint64_t answers,
                      std::int64_t round_trip_ns) {
  const std::string what =
      std::to_string(answers) + " answers, 99 % of them within " + milliseconds(round_trip_ns);
  if (answers > 0 && round_trip_ns <= kVeryLateNs) return {Grade::kOk, subject, what, ""};
  return {Grade::kWarning, subject, what,
          "run the service on this machine, end other programs that use it, and plug the device "
          "into a USB port of the machine itself"};
}

Finding judge_server(const ServerFacts& server, const std::string& address) {
  const std::string subject = "server " + address;
  if (server.welcomes) return {Grade::kOk, subject, "welcomes this bridge", ""};
  if (!server.connects) {
    return {Grade::kProblem, subject, server.words,
            "start irdm-server, and compare address and port with what it prints"};
  }
  if (!server.words.empty()) return from_error(Grade::kProblem, subject, server.words);
  return {Grade::kProblem, subject, "answers, but does not welcome this bridge",
          "see in its log why: all styluses may be taken, or it is no irdm-server"};
}

}  // namespace irdm::doctor

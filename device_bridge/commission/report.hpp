#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Commissioning: the first hour with a device, step by step, and what it found.
namespace irdm::commission {

enum class Verdict {
  kPassed,
  kFailed,
  kStopped,     ///< by the person
  kNotReached,  ///< a step before it did not pass
};

/// How a step ended.
struct StepRecord {
  std::string step = {};
  Verdict verdict = Verdict::kNotReached;
  std::string words = {};  ///< what was seen, and what to do
};

/// What the steps measured; nothing where a step did not get so far.
struct Measured {
  using Quantity = std::optional<double>;
  Quantity position_noise = {};  ///< at rest, standard deviation of the worst coordinate [m]
  Quantity velocity_noise = {};  ///< at rest, of differences from tick to tick [m/s]
  Quantity rate = {};            ///< ticks a second
  Quantity jitter = {};          ///< how far off 99 % of the ticks are at most [s]
  Quantity readings = {};        ///< new ones a second
  Quantity max_force = {};       ///< largest that was shown [N]
  Quantity stop_button = {};     ///< from the event to no force [s]; and the next two
  Quantity stop_link = {};       ///< of a server that is lost
  Quantity stop_cable = {};      ///< of a device that is
  Quantity stop_kill = {};  ///< from the kill of a bridge to the person's word that it is gone [s]
  Quantity wall_stiffness = {};      ///< largest at which the safety filter stayed passive [N/m]
  Quantity coupling_stiffness = {};  ///< proposed by that [N/m]
};

/// What commissioning a device found, as it is kept in a file.
struct Report {
  std::string type = {};    ///< as the key `type`
  std::string name = {};    ///< as the key `name`
  std::string device = {};  ///< HapticDevice::identity() of the one that was opened
  std::string date = {};    ///< "2026-11-27"
  Measured measured = {};
  std::vector<StepRecord> steps = {};

  /// All steps passed.
  bool signed_off() const noexcept;
};

/// For a person, a line each.
std::string to_text(const Report& report);
/// As a file, with that text as comments. @param file its name, as a configuration refers to it
std::string to_toml(const Report& report, const std::string& file);

/// Reads what to_toml() wrote. Throws Error with file and line, also for a report that is not
/// signed off.
Report load_report(const std::filesystem::path& path);

}  // namespace irdm::commission

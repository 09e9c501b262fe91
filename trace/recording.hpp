#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/config/range.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm::trace {

/// Refuses rows with numbers that no run has. All of these throw Error, which names the set and the
/// step.
class TraceCheck {
 public:
  /// @param file its name, for the message
  /// @param steps the force step of each row
  TraceCheck(std::string file, std::span<const std::uint64_t> steps)
      : file_(std::move(file)), steps_(steps) {}

  /// Every number, `width` of them a row.
  void numbers(const std::string& set, std::span<const double> values, std::size_t width,
               const Range& range = lab::kRecorded) const;
  void number(const std::string& set, std::size_t row, double value,
              const Range& range = lab::kRecorded) const;
  /// Quaternions of length 1.
  void orientations(const std::string& set, std::span<const double> values) const;
  /// Vectors of length 1.
  void directions(const std::string& set, std::span<const double> values) const;
  /// Numbers that are 0 or 1, `width` of them a row; or up to `highest`.
  void flags(const std::string& set, std::span<const std::uint8_t> values, std::size_t width = 1,
             std::uint8_t highest = 1) const;
  /// Three barycentric weights.
  void weights(const std::string& set, std::span<const double> values, std::size_t row) const;

  [[noreturn]] void refuse(const std::string& set, std::size_t row, const std::string& what) const;

 private:
  std::string file_;
  std::span<const std::uint64_t> steps_;
};

}  // namespace irdm::trace

namespace irdm {

/// A recorded run, read back whole: what each step did to the objects. Takes some 500 bytes a
/// step, and 160 for each contact between bodies.
class Recording {
 public:
  /// Reads a trace of these objects and styluses. Throws Error. Holds hdf5::library_mutex().
  /// @param names of the objects
  /// @param most steps that are read: what is wrong with later ones does not matter then
  Recording(const std::filesystem::path& path, const SimulationConfig& config,
            const std::vector<std::string>& names,
            std::size_t most = std::numeric_limits<std::size_t>::max());
  Recording(Recording&&) noexcept;
  Recording& operator=(Recording&&) noexcept;
  ~Recording();

  std::size_t steps() const noexcept;
  /// How many are missing between the first and the last: they were lost on the way to the disk.
  std::uint64_t lost_steps() const noexcept;
  /// Step i of the recording, 0 <= i < steps(). It is numbered i, whatever its number in the run
  /// was.
  void step(std::size_t i, StepRecord& record) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace irdm

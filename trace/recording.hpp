#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// A recorded run, read back whole: what each step did to the objects. Takes some 500 bytes a step.
class Recording {
 public:
  /// Reads a trace of these objects and styluses. Throws Error. Holds hdf5::library_mutex().
  /// @param names of the objects
  Recording(const std::filesystem::path& path, const SimulationConfig& config,
            const std::vector<std::string>& names);
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

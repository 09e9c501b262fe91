#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "common/realtime/wakeup.hpp"
#include "server/record/trace_writer.hpp"
#include "server/threads/step_sink.hpp"

namespace irdm {

/// Writes the steps of a run to its trace file. A write that fails ends the recording, is kept as
/// an error for the end of the run, and disturbs nobody.
class RecorderThread {
 public:
  /// Makes the file. Throws Error.
  RecorderThread(const std::filesystem::path& path, const TraceHeader& header);
  ~RecorderThread();

  /// Where the force thread puts its steps.
  StepSink& sink() noexcept { return sink_; }
  const StepSink& sink() const noexcept { return sink_; }

  void start();
  /// Writes what is left, completes the file and ends the thread.
  void finish();

  std::uint64_t rows() const noexcept { return rows_.load(std::memory_order_relaxed); }
  /// Why the recording ended early; empty when it did not. After finish().
  const std::string& error() const noexcept { return error_; }

 private:
  void run();
  void drain();
  void discard();

  TraceWriter writer_;
  StepSink sink_;
  std::vector<StepRecord> batch_;
  Wakeup stop_;
  std::atomic<std::uint64_t> rows_{0};
  std::string error_;
  std::thread thread_;
};

}  // namespace irdm

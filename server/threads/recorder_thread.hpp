#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/realtime/event_fd.hpp"
#include "server/threads/run_control.hpp"
#include "trace/trace_writer.hpp"

namespace irdm {

/// Writes the steps of a run to its trace file. A write that fails, or a file that is removed,
/// replaced or cut off, ends the recording. That is logged at once, is kept as an error for the
/// end of the run, and disturbs nobody.
class RecorderThread {
 public:
  /// The first step that is written.
  enum class From { kAny, kReset };
  static constexpr std::size_t kQueueCapacity = 4096;  ///< for a sink: 4 s at 1 kHz

  /// Makes the file. Throws Error. @param sink where the force thread puts its steps; must outlive
  /// the recorder
  RecorderThread(const std::filesystem::path& path, const TraceHeader& header, StepSink& sink,
                 From from = From::kAny);
  ~RecorderThread();

  void start();
  /// Writes what is left, completes the file and ends the thread.
  void finish();

  /// Steps that are missing because the disk was too slow.
  std::uint64_t lost() const noexcept { return sink_.lost() - lost_before_; }
  std::uint64_t rows() const noexcept { return rows_.load(std::memory_order_relaxed); }
  /// Whether the recording has ended early.
  bool failed() const noexcept { return failed_.load(std::memory_order_acquire); }
  /// Why the recording ended early; empty when it did not. After finish(), or once failed().
  const std::string& error() const noexcept { return error_; }

 private:
  void run();
  void drain();
  void keep_what_counts();
  void discard();

  std::optional<TraceWriter> writer_;  ///< always there, until the end
  StepSink& sink_;
  std::uint64_t lost_before_;
  bool begun_;
  std::vector<StepRecord> batch_;
  EventFd stop_;
  std::atomic<std::uint64_t> rows_{0};
  std::string error_;
  std::atomic<bool> failed_{false};
  std::thread thread_;
};

}  // namespace irdm

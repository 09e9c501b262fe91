#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "common/realtime/event_fd.hpp"
#include "common/realtime/histogram.hpp"
#include "common/realtime/triple_buffer.hpp"
#include "server/threads/run_control.hpp"
#include "simulation/deformation/deformation.hpp"

namespace irdm {

/// Computes the deformed surface at display rate and publishes it. It follows the force thread
/// through its own queue and never makes it wait.
class DeformationThread {
 public:
  /// @param rate surfaces a second [Hz]
  /// @param threads OpenMP threads, >= 1
  DeformationThread(const SimulationConfig& config, double rate, int threads);
  ~DeformationThread();

  /// Where the force thread puts its steps.
  StepSink& sink() noexcept { return sink_; }
  /// The newest surface; for one reader.
  TripleBuffer<SurfaceFrame>& surfaces() noexcept { return surfaces_; }
  /// Signalled whenever there is a new one.
  EventFd& surface_ready() noexcept { return surface_ready_; }

  /// @param beside_real_time leave a processor to the real-time threads
  void start(bool beside_real_time = false);
  /// After a last surface, of the last step.
  void finish();

  /// Steps that did not fit into its queue; any thread.
  std::uint64_t lost_steps() const noexcept { return lost_steps_.load(std::memory_order_relaxed); }
  std::uint64_t frames() const noexcept { return frames_.load(std::memory_order_relaxed); }
  /// Time to compute one surface; after finish().
  const Histogram& compute_time() const noexcept { return compute_time_; }

 private:
  void run(bool beside_real_time);
  void follow_and_compute();

  Deformation deformation_;
  std::int64_t period_ns_;
  int threads_;
  StepSink sink_;
  StepRecord record_;  ///< the last one taken
  TripleBuffer<SurfaceFrame> surfaces_;
  Histogram compute_time_;
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<std::uint64_t> lost_steps_{0};
  EventFd surface_ready_;
  EventFd stop_;
  std::thread thread_;
};

}  // namespace irdm

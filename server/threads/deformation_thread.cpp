#include "server/threads/deformation_thread.hpp"

#include <omp.h>
#include <pthread.h>

#include "common/realtime/clock.hpp"
#include "common/realtime/scheduling.hpp"

namespace irdm {
namespace {

constexpr std::size_t kQueueCapacity = 2048;  // 2 s at 1 kHz
// Nobody sees a millionth of an object's size.
constexpr double kInvisible = 1e-6;

}  // namespace

DeformationThread::DeformationThread(const SimulationConfig& config, double rate, int threads)
    : deformation_(config, kInvisible),
      period_ns_(static_cast<std::int64_t>(1e9 / rate)),
      threads_(threads),
      sink_(kQueueCapacity, step_shape(config)),
      surfaces_(rest_frame(config)) {}

DeformationThread::~DeformationThread() {
  finish();
}

void DeformationThread::start(bool beside_real_time) {
  thread_ = std::thread([this, beside_real_time] { run(beside_real_time); });
}

void DeformationThread::finish() {
  if (!thread_.joinable()) return;
  stop_.signal();
  thread_.join();
}

void DeformationThread::run(bool beside_real_time) {
  ::pthread_setname_np(::pthread_self(), "deformation");
  if (beside_real_time) spare_last_cpu();  // before there is a team, which inherits it
  omp_set_num_threads(threads_);
  PeriodicSchedule schedule(monotonic_ns(), period_ns_);
  for (bool stopped = false; !stopped;) {
    const std::int64_t now = monotonic_ns();
    const std::int64_t wait_ns = schedule.next(now) - now;
    // Stopped, it makes one round more: the last surface is that of the last step.
    stopped = stop_.wait(
        static_cast<int>(std::max<std::int64_t>(0, wait_ns) / kNanosecondsPerMillisecond));
    follow_and_compute();
  }
}

void DeformationThread::follow_and_compute() {
  bool moved = false;
  while (sink_.take(record_)) {
    deformation_.follow(record_);
    moved = true;
  }
  if (!moved) return;
  const std::int64_t begin = monotonic_ns();
  deformation_.compute(surfaces_.back());
  surfaces_.publish();
  surface_ready_.signal();
  lost_steps_.store(deformation_.lost_steps(), std::memory_order_relaxed);
  compute_time_.add(monotonic_ns() - begin);
  frames_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace irdm

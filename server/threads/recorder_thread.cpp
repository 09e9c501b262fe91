#include "server/threads/recorder_thread.hpp"

#include <exception>
#include <iostream>
#include <mutex>
#include <span>

#include "common/hdf5/handle.hpp"

namespace irdm {
namespace {
constexpr std::size_t kBatch = 128;  // a batch is large
constexpr int kFlushPeriodMs = 50;
}  // namespace

RecorderThread::RecorderThread(const std::filesystem::path& path, const TraceHeader& header,
                               StepSink& sink, From from)
    : sink_(sink), lost_before_(sink.lost()), begun_(from == From::kAny) {
  const std::lock_guard lock(hdf5::library_mutex());
  writer_.emplace(path, header);
  batch_.resize(kBatch);
}

RecorderThread::~RecorderThread() {
  finish();
  const std::lock_guard lock(hdf5::library_mutex());
  writer_.reset();
}

void RecorderThread::start() {
  thread_ = std::thread([this] { run(); });
}

void RecorderThread::finish() {
  if (!thread_.joinable()) return;
  stop_.signal();
  thread_.join();
}

void RecorderThread::run() {
  hdf5::prepare_library();
  bool stopped = false;
  try {
    while (!(stopped = stop_.wait(kFlushPeriodMs))) drain();
    drain();
    const std::lock_guard lock(hdf5::library_mutex());
    writer_->close();
  } catch (const std::exception& error) {
    error_ = error.what();
    failed_.store(true, std::memory_order_release);
    std::cerr << "irdm-server: error: recording ended early: " + error_ + "\n" << std::flush;
    keep_what_counts();
    // Keep taking, so that the queue does not report what the disk did.
    while (!stopped) {
      stopped = stop_.wait(kFlushPeriodMs);
      discard();
    }
  }
}

void RecorderThread::keep_what_counts() {
  try {
    const std::lock_guard lock(hdf5::library_mutex());
    writer_->close();
  } catch (const std::exception&) {
    // Of the same cause. What was flushed before counts.
  }
}

void RecorderThread::discard() {
  while (sink_.take(batch_.front())) {
  }
}

void RecorderThread::drain() {
  std::size_t count = 0;
  do {
    count = 0;
    while (count < kBatch && sink_.take(batch_[count])) {
      begun_ = begun_ || batch_[count].reset;
      count += begun_ ? 1 : 0;
    }
    const std::lock_guard lock(hdf5::library_mutex());
    writer_->append(std::span(batch_).first(count));
    // Batch by batch: what was appended counts, whatever the disk does with the next one.
    writer_->flush();
    rows_.fetch_add(count, std::memory_order_relaxed);
  } while (count == kBatch);
}

}  // namespace irdm

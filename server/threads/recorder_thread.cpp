#include "server/threads/recorder_thread.hpp"

#include <exception>
#include <mutex>

#include "common/hdf5/handle.hpp"

namespace irdm {
namespace {
constexpr std::size_t kBatch = 512;
constexpr int kFlushPeriodMs = 50;
}  // namespace

RecorderThread::RecorderThread(const std::filesystem::path& path, const TraceHeader& header,
                               StepSink& sink, From from)
    : sink_(sink), lost_before_(sink.lost()), begun_(from == From::kAny) {
  const std::lock_guard lock(hdf5::library_mutex());
  writer_.emplace(path, header);
  batch_.reserve(kBatch);
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
  StepRecord dropped;
  while (sink_.take(dropped)) {
  }
}

void RecorderThread::drain() {
  StepRecord record;
  do {
    batch_.clear();
    while (batch_.size() < kBatch && sink_.take(record)) {
      begun_ = begun_ || record.reset;
      if (begun_) batch_.push_back(record);
    }
    const std::lock_guard lock(hdf5::library_mutex());
    writer_->append(batch_);
    // Batch by batch: what was appended counts, whatever the disk does with the next one.
    writer_->flush();
    rows_.fetch_add(batch_.size(), std::memory_order_relaxed);
  } while (batch_.size() == kBatch);
}

}  // namespace irdm

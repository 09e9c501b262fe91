#include "server/threads/recorder_thread.hpp"

#include <exception>

namespace irdm {
namespace {
constexpr std::size_t kQueueCapacity = 4096;  // 4 s at 1 kHz
constexpr std::size_t kBatch = 512;
constexpr int kPeriodMs = 50;
}  // namespace

RecorderThread::RecorderThread(const std::filesystem::path& path, const TraceHeader& header)
    : writer_(path, header), sink_(kQueueCapacity) {
  batch_.reserve(kBatch);
}

RecorderThread::~RecorderThread() {
  finish();
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
  hdf5::silence_this_thread();
  bool stopped = false;
  try {
    while (!(stopped = stop_.wait(kPeriodMs))) {
      drain();
      writer_.flush();
    }
    drain();
    writer_.close();
  } catch (const std::exception& error) {
    error_ = error.what();
    // Keep taking, so that the queue does not report what the disk did.
    while (!stopped) {
      stopped = stop_.wait(kPeriodMs);
      discard();
    }
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
    while (batch_.size() < kBatch && sink_.take(record)) batch_.push_back(record);
    writer_.append(batch_);
    rows_.fetch_add(batch_.size(), std::memory_order_relaxed);
  } while (batch_.size() == kBatch);
}

}  // namespace irdm

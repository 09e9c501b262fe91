#include "common/blackbox/black_box.hpp"

#include <pthread.h>
#include <spdlog/spdlog.h>
#include <algorithm>
#include <exception>
#include <utility>

#include "common/blackbox/black_box_file.hpp"
#include "common/hdf5/file.hpp"
#include "common/realtime/clock.hpp"

namespace irdm {
namespace {

constexpr int kPeriodMs = 50;

std::string words(const Fault& fault) {
  return fault.detail.empty() ? fault.kind : fault.kind + ": " + fault.detail;
}

}  // namespace

BlackBox::BlackBox(BlackBoxSettings settings, std::string program, std::vector<BlackBoxPart*> parts)
    : settings_(std::move(settings)), program_(std::move(program)), parts_(std::move(parts)) {
  spdlog::default_logger();  // made before any thread logs
}

BlackBox::~BlackBox() {
  finish();
}

void BlackBox::start() {
  thread_ = std::thread([this] { run(); });
  ::pthread_setname_np(thread_.native_handle(), "black box");
}

void BlackBox::report(const std::string& kind, const std::string& detail) {
  const Fault fault{monotonic_ns(), kind, detail};
  if (!reported_.push(fault)) spdlog::warn("{}: no black box: too many at a time", words(fault));
}

void BlackBox::finish() {
  if (!thread_.joinable()) return;
  stop_.signal();
  thread_.join();
}

void BlackBox::run() {
  hdf5::prepare_library();
  for (bool stopped = false; !stopped;) {
    stopped = stop_.wait(kPeriodMs);
    const std::int64_t now_ns = monotonic_ns();
    look(now_ns);
    write_due(now_ns, stopped);
  }
}

void BlackBox::look(std::int64_t now_ns) {
  std::vector<Fault> faults;
  for (Fault fault; reported_.pop(fault);) faults.push_back(fault);
  for (BlackBoxPart* part : parts_) {
    if (const std::optional<Fault> fault = part->take()) faults.push_back(*fault);
  }
  std::stable_sort(faults.begin(), faults.end(),
                   [](const Fault& a, const Fault& b) { return a.time_ns < b.time_ns; });
  for (const Fault& fault : faults) begin(fault);
  const std::int64_t end_ns = due_ ? std::min(now_ns, due_->time_ns) : now_ns;
  for (BlackBoxPart* part : parts_) part->forget(end_ns);
}

// A fault beside one that is due is in its file.
void BlackBox::begin(const Fault& fault) {
  if (due_) return;
  const auto last = written_.find(fault.kind);
  if (last != written_.end() && fault.time_ns - last->second < kRestNs) return;
  due_ = fault;
}

void BlackBox::write_due(std::int64_t now_ns, bool last) {
  if (!due_ || (now_ns - due_->time_ns < kAftermathNs && !last)) return;
  written_[due_->kind] = due_->time_ns;
  write(*due_);
  due_.reset();
}

void BlackBox::write(const Fault& fault) noexcept {
  try {
    const auto path = write_black_box(settings_.folder, settings_.files, program_, fault, parts_);
    spdlog::warn("{}: the last seconds are in {}", words(fault), path.string());
  } catch (const std::exception& error) {
    spdlog::error("{}: no black box: {}", words(fault), error.what());
  }
}

}  // namespace irdm

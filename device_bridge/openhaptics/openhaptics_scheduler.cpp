#include "device_bridge/openhaptics/openhaptics_scheduler.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "device_bridge/openhaptics/hd_error.hpp"
#include "device_bridge/openhaptics/openhaptics_device.hpp"

namespace irdm {
namespace {

constexpr long kUsualRate = 1000;  // of a driver that does not let it be chosen [Hz]
constexpr int kMostErrors = 16;    // fetched at a time

}  // namespace

void OpenHapticsScheduler::start(double rate, std::function<bool()> tick) {
  const long hertz = std::lround(rate);
  api_.set_scheduler_rate(static_cast<unsigned long>(hertz));
  if (api_.get_error().code != hd::kSuccess && hertz != kUsualRate) {
    throw Error("OpenHaptics", "the driver does not run at " + std::to_string(hertz) + " Hz",
                "set bridge.rate = 1000");
  }
  tick_ = std::move(tick);
  period_ns_ = 1'000'000'000 / hertz;
  scheduled_ = api_.schedule_asynchronous(call, this, hd::kHighestPriority);
  running_ = true;
  check_started("takes no callback");
  api_.start_scheduler();
  check_started("does not start its servo loop");
}

void OpenHapticsScheduler::check_started(const std::string& what) {
  const hd::ErrorInfo error = api_.get_error();
  if (error.code == hd::kSuccess) return;
  stop();
  throw Error("OpenHaptics", "the driver " + what + ": " + to_text(error),
              hd::describe(error.code).remedy);
}

void OpenHapticsScheduler::stop() noexcept {
  if (!running_) return;
  running_ = false;
  api_.stop_scheduler();
  api_.unschedule(scheduled_);
}

void OpenHapticsScheduler::remove(OpenHapticsDevice& device) noexcept {
  devices_.erase(std::remove(devices_.begin(), devices_.end(), &device), devices_.end());
}

std::uint32_t OpenHapticsScheduler::call(void* self) {
  const bool more = static_cast<OpenHapticsScheduler*>(self)->tick_();
  return more ? hd::kCallbackContinue : hd::kCallbackDone;
}

void OpenHapticsScheduler::fetch_errors(OpenHapticsDevice& here) noexcept {
  for (int i = 0; i < kMostErrors; ++i) {
    const hd::ErrorInfo error = api_.get_error();
    if (error.code == hd::kSuccess) return;
    give(error, here);
  }
}

void OpenHapticsScheduler::forget_errors() noexcept {
  for (int i = 0; i < kMostErrors && api_.get_error().code != hd::kSuccess; ++i) {
  }
}

void OpenHapticsScheduler::give(const hd::ErrorInfo& error, OpenHapticsDevice& here) noexcept {
  const auto about = std::find_if(
      devices_.begin(), devices_.end(),
      [&](const OpenHapticsDevice* device) { return device->handle() == error.device; });
  (about == devices_.end() ? here : **about).take(error);
}

}  // namespace irdm

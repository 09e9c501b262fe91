#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "device_bridge/haptic_device.hpp"
#include "device_bridge/openhaptics/hd_library.hpp"

namespace irdm {

class OpenHapticsDevice;

/// The driver's scheduler, the only thread that may read its devices and set their forces: the
/// servo loop's tick runs inside its callback, for all devices at once. One a process.
class OpenHapticsScheduler : public TickSource {
 public:
  explicit OpenHapticsScheduler(const hd::Api& api) : api_(api) {}
  ~OpenHapticsScheduler() override { stop(); }

  /// After the devices are open. Throws Error when the driver does not run at this rate.
  void start(double rate, std::function<bool()> tick) override;
  void stop() noexcept override;

  const hd::Api& api() const noexcept { return api_; }
  /// From one tick to the next; after start().
  std::int64_t period_ns() const noexcept { return period_ns_; }
  /// An open device; while the scheduler does not run.
  void add(OpenHapticsDevice& device) { devices_.push_back(&device); }
  void remove(OpenHapticsDevice& device) noexcept;
  /// Fetches the driver's errors and gives each to the device that it is about, those about none to
  /// `here`. Real-time safe.
  void fetch_errors(OpenHapticsDevice& here) noexcept;
  /// What a driver says to questions that it does not know is nobody's error; while the scheduler
  /// does not run.
  void forget_errors() noexcept;
  /// Gives one error to the device that it is about, or to `here`. Real-time safe.
  void give(const hd::ErrorInfo& error, OpenHapticsDevice& here) noexcept;

 private:
  static std::uint32_t call(void* self);
  void check_started(const std::string& what);

  const hd::Api& api_;
  std::vector<OpenHapticsDevice*> devices_;
  std::function<bool()> tick_;
  std::int64_t period_ns_ = 1'000'000;
  hd::ScheduleHandle scheduled_ = 0;
  bool running_ = false;
};

}  // namespace irdm

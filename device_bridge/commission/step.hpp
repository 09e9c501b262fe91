#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "device_bridge/commission/report.hpp"
#include "device_bridge/haptic_device.hpp"

namespace irdm::commission {

/// What a step sees of a tick of the servo loop, when the force of the tick is shown.
struct Seen {
  double elapsed = 0.0;           ///< since the tick before [s]; 0 in a step's first
  Vector3 tip = Vector3::Zero();  ///< as it was read, not a number: of no use [m], D
  std::uint32_t buttons = 0;      ///< the device's own bits
  DeviceState device = {};
  Vector3 shown = Vector3::Zero();  ///< force [N], D
  double gain = 1.0;                ///< of the OscillationDetector
  bool fault = false;               ///< of the safety filter
};

/// What a step wants to be shown until the next tick; the safety filter has the last word.
struct Demand {
  Vector3 force = Vector3::Zero();  ///< [N], D
  bool linked = true;               ///< false: as if the server were lost
  /// From a contact that answers the tip: it has an age, and the filter keeps it passive. What does
  /// not answer the tip cannot shake the hand.
  bool contact = false;
};

/// What a person is to do with the handle.
struct Order {
  enum class Kind {
    kHold,    ///< keep it where it is, loosely
    kRest,    ///< let go of it
    kMove,    ///< 5 cm along `direction`
    kPress,   ///< press and release `button`
    kStop,    ///< hold it, and press `button` once the force is felt
    kUnplug,  ///< hold it, and pull the cable once the force is felt
    kTap,     ///< press down onto the wall and lift off, again and again
  };
  Kind kind = Kind::kHold;
  Vector3 direction = Vector3::Zero();  ///< unit, D
  int button = -1;                      ///< bit
};

struct Request {
  Order order = {};
  std::string words = {};  ///< the same for a person
};

struct Judgement {
  bool passed = false;
  std::string words = {};
};

/// One step of commissioning a device, fed with ticks: from its first one on it says which force to
/// show, until it is over. Knows no thread, clock or file. A step is used once.
class Step {
 public:
  Step(std::string name, Request request) : name_(std::move(name)), request_(std::move(request)) {}
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;
  virtual ~Step() = default;

  const std::string& name() const noexcept { return name_; }
  const Request& request() const noexcept { return request_; }

  /// One tick. Servo thread, real-time safe.
  virtual Demand tick(const Seen& seen) noexcept = 0;
  /// Needs no more ticks. Servo thread.
  virtual bool over() const noexcept = 0;
  /// What came of it, once it is over.
  /// @param measured gets what this step measured
  virtual Judgement judge(Measured& measured) const = 0;

 private:
  std::string name_;
  Request request_;
};

/// How a step ended that had its last tick.
StepRecord judged(const Step& step, Measured& measured);

/// "right", "up", "towards you" for the axis of D that a person moves along; 0 to 2.
const char* direction_word(int axis) noexcept;
/// "+x" to "-z" for the coordinate of `way` that is largest.
std::string axis_word(const Vector3& way);
/// Whether one coordinate of `way` is at least twice as large as the others.
bool along_an_axis(const Vector3& way) noexcept;
/// Four digits and a unit.
std::string in_unit(double value, const char* unit);

}  // namespace irdm::commission

#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/wire/frame.hpp"
#include "device_bridge/link/force_receiver.hpp"
#include "device_bridge/servo_loop.hpp"
#include "simulation/step/bridged_stylus.hpp"
#include "simulation/step/simulation.hpp"

namespace irdm::test {

/// What goes wrong between a hand and the object that it presses.
enum class Cause {
  kServerKilled,   ///< its side of the connection closes
  kServerStopped,  ///< no step any more, the connection stays
  kCableCut,       ///< nothing comes through either way
  kSilentServer,   ///< nothing from the server comes through
  kSilentBridge,   ///< nothing from the bridge comes through
  kCorrupted,      ///< a bit of each frame from the server is wrong
  kReordered,      ///< each frame from the server changes places with the next
  kOldFrames,      ///< the server's frames are held back, and then all come
  kSlowReader,     ///< of the server's frames one comes in 40 ms, the others wait
  kSecondMaster,   ///< forces of another session
  kForged,         ///< forces for samples that were never sent
  kRepeated,       ///< the last frame, again and again
  kClockForward,   ///< the bridge's clock
  kClockBackward,
  kBridgeStopped,  ///< its ticks, for a while
  kBlindDevice,    ///< its readings are no numbers
};
inline constexpr int kCauses = 16;
std::string word(Cause cause);

/// A hand that presses a cube, over a link of 1 ms each way in whole frames, on a virtual clock:
/// the bridge's servo loop and intake of forces, the server's simulation, and something that goes
/// wrong.
class FailingLink {
 public:
  FailingLink(Cause cause, bool predict, std::uint64_t seed);
  ~FailingLink();

  struct Outcome {
    double force_before = 0.0;    ///< when it goes wrong [N]
    std::int64_t valid_ns = 0;    ///< when the last good frame came, from then [ns]
    std::int64_t zero_ns = -1;    ///< first tick without force, from then; -1: none [ns]
    double force_after = 0.0;     ///< largest after that, until the link could be good again [N]
    double largest_rise = 0.0;    ///< of the force in a tick [N]
    std::int64_t absent_ns = 0;   ///< from then on no tick came: the device's own watchdog's [ns]
    std::int64_t horizon_ns = 0;  ///< that the bridge trusts a good frame for
  };
  Outcome run();

 private:
  struct Timed {
    std::int64_t time_ns;
    wire::FrameBytes bytes;
    bool overtaken = false;
  };
  class Device;

  void tick();
  void bridge();
  void deliver_down();
  void take(const wire::Frame& frame);
  void serve();
  void send_down(const wire::Message& message, std::uint32_t session);
  bool wrong(Cause cause) const { return wrong_since_ns_ && cause_ == cause; }
  std::int64_t bridge_clock() const;

  Cause cause_;
  bool predict_;
  std::mt19937_64 random_;
  std::int64_t now_ns_ = 1'000'000'000;
  std::optional<std::int64_t> wrong_since_ns_;

  // The bridge:
  std::unique_ptr<Device> device_;
  ServoLoop loop_;
  ForceReceiver intake_{false};
  ClientReport report_;
  bool linked_ = true;
  std::int64_t answered_ns_ = 0;
  std::int64_t valid_ns_ = 0;
  std::int64_t horizon_ns_ = 20'000'000;

  // The way:
  std::deque<std::pair<std::int64_t, StylusSample>> samples_;
  std::deque<std::pair<std::int64_t, AppliedForces>> applied_;
  std::deque<Timed> down_;
  std::int64_t next_slow_ns_ = 0;
  std::uint64_t frames_ = 0;
  wire::FrameReader reader_;
  std::optional<std::uint64_t> last_frame_;

  // The server:
  Simulation simulation_;
  BridgedStylus bridged_;
  AppliedHistory history_{1};
  StylusCommand command_;
  StylusSample newest_;
  std::int64_t heard_ns_ = 0;
  StepRecord record_;
  ContactModel model_;
};

}  // namespace irdm::test

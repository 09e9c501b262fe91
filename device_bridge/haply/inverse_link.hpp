#pragma once

// Must come before Boost's own headers: it mends Boost 1.74 under C++20.
#include "common/wire/asio.hpp"

#include <chrono>
#include <cstdint>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "common/realtime/histogram.hpp"
#include "common/realtime/triple_buffer.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/haply/inverse_messages.hpp"
#include "device_bridge/haply/service_socket.hpp"

namespace irdm::haply {

/// A state or a force that is older is of no use [ns].
inline constexpr std::int64_t kLongestAgeNs = 50'000'000;

/// The newest state of the device. Frame D.
struct InverseReading {
  std::int64_t time_ns = 0;      ///< when it came; 0: none yet
  std::uint64_t generation = 0;  ///< another one than before: the force begins anew
  bool ready = false;            ///< it may get a force
  Vector3 tip = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();
  std::uint32_t buttons = 0;
};

/// The newest force for it.
struct InverseForce {
  std::int64_t time_ns = 0;
  std::uint64_t generation = 0;     ///< of the reading that it goes with
  Vector3 force = Vector3::Zero();  ///< [N], D
};

/// Hand-over between servo thread and network thread. Neither ever waits for the other.
struct InverseMailbox {
  TripleBuffer<InverseReading> reading;  ///< network writes
  TripleBuffer<InverseForce> force;      ///< servo writes
};

struct InverseSettings {
  ServerAddress service = {"localhost", 10001};
  std::uint16_t old_http_port = 10000;  ///< where services before 3.5 take settings
  std::string device = {};  ///< its id; empty: the first that this process has not opened
  std::string grip = {};    ///< likewise; empty: the first in a message
  RealTimeScheduling scheduling = RealTimeScheduling::kIgnore;
};

/// How long the service took to answer, and what went wrong.
struct InverseReport {
  std::uint64_t answers = 0;
  double sum = 0.0;           ///< from a message to its answer, of all [s]
  Histogram round_trip = {};  ///< the same [ns]
  std::uint64_t bad_messages = 0;
  std::uint64_t reconnects = 0;
};

/// In words.
std::string to_text(const InverseReport& report);

/// A connection to the Inverse Service for one device, in a thread of its own: 2000 times a second,
/// when the last answer is there, it sends the newest force, and the answer is the newest state.
/// Where the device is not ready, the force is old or goes with an earlier generation, or the
/// answer is late, it sends zero. A connection that is lost is made again; the last that one hears
/// that is closed is zero.
/// Large: each private method is one step in the life of the connection, in one thread.
class InverseLink {
 public:
  InverseLink(InverseSettings settings, InverseMailbox& mailbox);
  InverseLink(const InverseLink&) = delete;
  InverseLink& operator=(const InverseLink&) = delete;
  ~InverseLink() { close(); }

  /// Connects, chooses the device and sets it up. Throws Error when there is no service or no such
  /// device, or when this process has opened it already.
  void open();
  void close() noexcept;

  /// The chosen one, as the service told then; after open().
  const InverseDevice& device() const noexcept { return device_; }
  /// What is wrong and what to do; empty: nothing. Any thread.
  std::string trouble() const;
  /// After close().
  const InverseReport& report() const noexcept { return report_; }

 private:
  enum class Phase {
    kConnecting,  ///< until the first message came
    kExchanging,
    kAbsent,  ///< the service is there, the device is not
    kEnding,
  };

  void run() noexcept;
  void connect();
  void take(const std::string& text);
  void take_inventory(const ServiceMessage& inventory);
  bool choose(const ServiceMessage& inventory);
  void set_up(const ServiceMessage& inventory, const InverseDevice& device);
  void turn_gravity_on();
  void begin_exchange();
  void take_update(const ServiceMessage& update);
  void take_state(const InverseDevice& device, const ServiceMessage& update);
  void tell_status(const InverseStatus& status);
  void count_answer();
  void turn();
  void send_force(std::int64_t now_ns);
  void end_turn(std::int64_t now_ns);
  void wait(std::int64_t period_ns);
  void wake_at(std::int64_t time_ns, void (InverseLink::*then)());
  void give_up_connecting();
  void send(std::string text, std::int64_t now_ns);
  Vector3 newest_force(std::int64_t now_ns);
  void withhold();
  void refuse(const std::string& what, const std::string& remedy);
  void fail(const std::string& cause, const std::string& remedy);
  void begin_end();
  void complain(const std::string& what);
  std::string label() const;

  const InverseSettings settings_;
  InverseMailbox& mailbox_;
  InverseDevice device_;
  std::string claim_;  ///< on the device, within this process; empty: none
  ForceKey key_ = ForceKey::kValues;
  Phase phase_ = Phase::kConnecting;
  InverseReading reading_;
  std::deque<std::int64_t> sent_ns_;  ///< of messages without an answer yet
  std::int64_t last_good_ns_ = 0;     ///< of a message that is of use
  std::int64_t next_turn_ns_ = 0;
  std::int64_t end_ns_ = 0;  ///< the end waits no longer
  bool said_zero_ = false;   ///< at the end
  bool left_ = false;        ///< likewise
  bool waited_for_ = true;   ///< by open()
  std::promise<void> opened_;
  InverseReport report_;
  mutable std::mutex trouble_mutex_;
  std::string trouble_;
  boost::asio::io_context io_;
  boost::asio::steady_timer timer_{io_};
  std::uint64_t alarm_ = 0;  ///< that the timer is set for
  std::shared_ptr<ServiceSocket> socket_;
  std::thread thread_;
};

}  // namespace irdm::haply

#pragma once

// Must come before Boost's own headers: it mends Boost 1.74 under C++20.
#include "common/wire/asio.hpp"

#include <cstdint>
#include <exception>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "device_bridge/haply/alarm.hpp"
#include "device_bridge/haply/inverse_events.hpp"
#include "device_bridge/haply/inverse_exchange.hpp"
#include "device_bridge/haply/inverse_opening.hpp"
#include "device_bridge/haply/service_socket.hpp"

namespace irdm::haply {

/// A connection to the Inverse Service for one device, in a thread of its own: 2000 times a second,
/// when the last answer is there, it sends the newest force, and the answer is the newest state
/// (InverseExchange). A connection that is lost is made again; the last that one hears that is
/// closed is zero. The events of a service from 3.5 on are heard where they can be; their channel,
/// too, is opened again when it is lost.
/// Large: each private method is one step in the life of the connection, in one thread.
class InverseLink {
 public:
  InverseLink(InverseSettings settings, InverseMailbox& mailbox);
  InverseLink(const InverseLink&) = delete;
  InverseLink& operator=(const InverseLink&) = delete;
  ~InverseLink() { close(); }

  /// Connects, chooses the device and sets it up. Throws Error when there is no service or no such
  /// device, or when this process or another session has opened it already.
  void open();
  void close() noexcept;

  /// The chosen one, as the service told then; after open().
  const InverseDevice& device() const noexcept { return opened_->device; }
  /// What is wrong and what to do; empty: nothing. Any thread.
  std::string trouble() const { return trouble_.text(); }
  /// After close().
  const InverseReport& report() const noexcept { return report_; }

 private:
  enum class Phase {
    kConnecting,  ///< until the first message came
    kExchanging,
    kAbsent,  ///< the service is there, the device is not
    kEnding,
  };
  struct Ending {
    std::int64_t deadline_ns = 0;
    bool said_zero = false;
    bool left = false;
  };

  void run() noexcept;
  void connect();
  void listen_to_events();
  void take(const std::string& text);
  void take_inventory(const ServiceMessage& inventory);
  void take_update(const ServiceMessage& update);
  void take_event(const std::string& text);
  void begin_exchange(const InverseDevice& device);
  void be_absent(const std::string& what);
  void turn();
  void end_turn(std::int64_t now_ns);
  void wait(std::int64_t period_ns);
  void send(std::string text, std::int64_t now_ns);
  void refuse(const std::exception_ptr& error);
  void fail(const std::string& cause, const std::string& remedy);

  const InverseSettings settings_;
  TroubleText trouble_;
  InverseReport report_;
  InverseExchange exchange_;
  std::optional<OpenedDevice> opened_;
  Phase phase_ = Phase::kConnecting;
  Ending ending_;
  std::int64_t last_good_ns_ = 0;  ///< of a message that is of use
  std::int64_t next_turn_ns_ = 0;
  std::optional<std::promise<void>> waiting_;  ///< open(), for the first state
  boost::asio::io_context io_;
  Alarm alarm_{io_};
  Alarm events_alarm_{io_};
  std::shared_ptr<ServiceSocket> socket_;
  std::shared_ptr<ServiceSocket> events_;  ///< null: none
  std::thread thread_;
};

}  // namespace irdm::haply

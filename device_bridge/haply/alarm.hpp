#pragma once

// Must come before Boost's own headers: it mends Boost 1.74 under C++20.
#include "common/wire/asio.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>

namespace irdm::haply {

/// One call at a time of the clock, in the thread of an io_context. Setting it again cancels the
/// call before.
class Alarm {
 public:
  explicit Alarm(boost::asio::io_context& io) : timer_(io) {}

  /// @param time_ns monotonic_ns()
  void set(std::int64_t time_ns, std::function<void()> call) {
    const std::uint64_t number = ++newest_;
    timer_.expires_at(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns)));
    timer_.async_wait([this, number, call = std::move(call)](boost::system::error_code error) {
      if (!error && number == newest_) call();  // an earlier one may be due already
    });
  }
  void cancel() noexcept { ++newest_; }

 private:
  boost::asio::steady_timer timer_;
  std::uint64_t newest_ = 0;
};

}  // namespace irdm::haply

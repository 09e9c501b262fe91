#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/geometry.hpp"
#include "device_bridge/haply/inverse_link.hpp"
#include "tests/support/child_process.hpp"

namespace irdm::test {

/// The fake Inverse Service (fake_inverse_service.cpp) and what a test asks of it.
class FakeService {
 public:
  /// @param devices their ids, with blanks between them
  explicit FakeService(const std::string& version = "3.5", const std::string& devices = "049D");

  /// As if somebody pulled its plug: no goodbye to anybody.
  void kill();
  /// Again on the same port, after kill().
  void start();

  /// Gives an order (FakeWorld::obey) and returns the answer.
  std::string order(const std::string& line) const;
  /// What a device was told so far.
  struct Told {
    Vector3 force;  ///< last [N], the service's axes
    std::uint64_t forces = 0;
    bool gravity = false;  ///< is compensated
    double largest = 0.0;  ///< magnitude [N]
  };
  Told told(const std::string& device = "049D") const;
  /// Of messages that the documents do not permit; the last of them behind the number.
  std::string misuses() const { return order("misuses"); }

  std::uint16_t port() const noexcept { return port_; }
  haply::InverseSettings settings(const std::string& device = "") const;

 private:
  std::string version_;
  std::string devices_;
  std::uint16_t port_ = 0;
  std::uint16_t old_http_port_ = 0;
  std::uint16_t events_port_ = 0;
  std::uint16_t orders_port_ = 0;
  std::optional<ChildProcess> process_;
};

}  // namespace irdm::test

#pragma once

#include <optional>
#include <string>

namespace irdm::haply {

/// A device that this process has opened, by id: a service has more than one address. Released at
/// its end. Any thread.
class DeviceClaim {
 public:
  /// None: the device is open already.
  static std::optional<DeviceClaim> lay(const std::string& id);

  DeviceClaim(DeviceClaim&& other) noexcept;
  DeviceClaim& operator=(DeviceClaim&& other) = delete;
  ~DeviceClaim();

 private:
  explicit DeviceClaim(std::string id);

  std::string id_;  ///< empty: moved from
};

}  // namespace irdm::haply

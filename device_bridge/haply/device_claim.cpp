#include "device_bridge/haply/device_claim.hpp"

#include <mutex>
#include <set>
#include <utility>

namespace irdm::haply {
namespace {

std::mutex claims_mutex;
std::set<std::string> claims;

}  // namespace

std::optional<DeviceClaim> DeviceClaim::lay(const std::string& id) {
  const std::lock_guard<std::mutex> lock(claims_mutex);
  if (!claims.insert(id).second) return std::nullopt;
  return DeviceClaim(id);
}

DeviceClaim::DeviceClaim(std::string id) : id_(std::move(id)) {}

DeviceClaim::DeviceClaim(DeviceClaim&& other) noexcept : id_(std::exchange(other.id_, {})) {}

DeviceClaim::~DeviceClaim() {
  if (id_.empty()) return;
  const std::lock_guard<std::mutex> lock(claims_mutex);
  claims.erase(id_);
}

}  // namespace irdm::haply
